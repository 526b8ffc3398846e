// Cloth made of triangles: its rest shape in material coordinates, and regular sheets.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "physics/mesh/mesh.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// A band along a chain of edges: an elastic band, a hem, or a seam allowance.
struct Band {
  std::vector<Index> vertices;
  std::vector<double> lengths;  ///< rest lengths of the cloth between consecutive vertices [m]
  double ratio = 1;             ///< rest length of the band / rest length of the cloth along it
  double stiffness = 0;         ///< force per strain [N]
  double mass = 0;              ///< per length of cloth [kg/m]
  double bend = 0;              ///< bending stiffness [N·m²]
  double allowance = 0;         ///< width of cloth along the band that the triangles do not contain [m]
};

/// Two vertices that a fastener holds together while it is closed. A fastener is a button, a tooth of a zip, or a seam
/// that can tear. `open` and `closed` are the scene times at which the fastener opens and closes [s]; infinite: never.
/// If `closed` < `open`, the fastener is closed only between these times; otherwise it is closed at the start.
struct Tie {
  /// Distance up to which a fastener does not pull [m]: slightly above the contact thickness of most fabrics, so that
  /// ties do not press the layers together. From twice this distance on, it pulls with its full strength.
  static constexpr double kRest = 0.003;
  Index a = 0, b = 0;
  double strength = 0;  ///< maximum force [N]
  int tearing = -1;     ///< index of the seam in Sheet::tearing_seams; −1: the tie never tears
  double open = std::numeric_limits<double>::infinity(), closed = std::numeric_limits<double>::infinity();
};

/// Factors by which one triangle multiplies the in-plane stiffness, bending stiffness and areal
/// density of its cloth.
struct Reinforcement {
  double stretch = 1, bend = 1, density = 1;

  bool operator==(const Reinforcement&) const = default;
};

/// Rest shape of cloth made of triangles, flat or not.
struct Sheet {
  std::vector<Triangle> triangles;            ///< manifold and equally oriented
  std::vector<Vec3> rest;                     ///< per vertex [m]
  std::vector<std::array<Vec2, 3>> material;  ///< (weft, warp) of each triangle's corners, counter-clockwise [m]
  bool sewn = false;  ///< made of flat panels: `material` alone is the rest shape, and `rest` are start positions
  std::vector<Band> bands;
  std::vector<Tie> ties;
  std::vector<std::string> tearing_seams;     ///< names of the seams that tear
  std::vector<Reinforcement> reinforcements;  ///< per triangle; empty: no reinforcement
};

/// Area of a triangle at rest [m²].
double rest_area(const Sheet& sheet, std::size_t triangle);

/// Maximum ratio of a cloth's longest edge to its smallest triangle height (on grids: to its smallest spacing) with
/// which the cloth may touch obstacles. Measured with sheets that fall on a ball, at default settings. If one row of
/// triangles was thin, eight of nine runs succeeded at a ratio of 71, none at 141. With graded rectangles, all runs
/// succeeded at a grading of 50, none at 100.
inline constexpr double kMaxEdgeToHeightRatio = 80;

/// Triangles of a sheet whose smallest height at rest is below (longest edge of the sheet) /
/// kMaxEdgeToHeightRatio.
struct FlatTriangles {
  std::size_t count = 0, flattest = 0;  ///< their number; triangle with the smallest height of all
  double least_height = 0;              ///< height of `flattest` [m]; infinite without triangles
  double longest_edge = 0;              ///< [m]
};
FlatTriangles find_flat_triangles(const Sheet& sheet);

/// Makes a sheet whose rest shape is the mesh. In each triangle, the weft runs along the projection of the x axis; in
/// triangles nearly perpendicular to that axis, along the cross product of the y axis and the normal. Thus a flat mesh
/// in the x-y plane whose normals point toward +z has x as weft and y as warp. Each triangle has
/// its own material coordinates.
Sheet make_sheet_from_mesh(const Mesh& mesh);

/// Smallest height of all triangles at rest [m]; infinite without triangles.
double min_height(const Sheet& sheet);

/// How each cell of a grid is cut.
enum class Pattern {
  aligned,  ///< along the diagonal from (0,0) to (1,1), the same in all cells
  crossed,  ///< along both diagonals, with a vertex in the middle
};

/// Like make_sheet() (quads.hpp), but made of triangles. The vertices in the middle of crossed cells come after those
/// of the grid.
Mesh make_triangle_sheet(const Grid& grid, Pattern pattern);

}  // namespace weft::mesh
