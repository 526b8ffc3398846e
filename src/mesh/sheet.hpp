// Cloth of triangles: its rest shape in material coordinates, and regular sheets.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/topology.hpp"

namespace weft::mesh {

/// A band along a chain of edges: elastic, a hem, or the allowance of a seam.
struct Band {
  std::vector<Index> vertices;
  std::vector<double> lengths;  ///< of the cloth's edges between them [m]
  double ratio = 1;             ///< rest length of the band by that of the cloth
  double stiffness = 0;         ///< force per strain [N]
  double mass = 0;              ///< per length of the cloth [kg/m]
  double bend = 0;              ///< bending stiffness [N·m²]
  double allowance = 0;         ///< width of cloth that lies along it beside what the triangles are [m]
};

/// Two vertices that a button or a tooth of a zip holds together while it is closed. Times are those of the scene [s];
/// without one nothing happens.
struct Tie {
  Index a = 0, b = 0;
  double strength = 0;  ///< most that it pulls with [N]
  double open = std::numeric_limits<double>::infinity(), closed = std::numeric_limits<double>::infinity();
};

/// Of a triangle against the cloth's material: factors on stiffness in the plane, in bending, and mass.
struct Reinforcement {
  double stretch = 1, bend = 1, density = 1;

  bool operator==(const Reinforcement&) const = default;
};

/// Rest shape of cloth made of triangles, flat or not.
struct Sheet {
  std::vector<Triangle> triangles;            ///< manifold and equally oriented
  std::vector<Vec3> rest;                     ///< per vertex [m]
  std::vector<std::array<Vec2, 3>> material;  ///< (weft, warp) of each triangle's corners, counter-clockwise [m]
  bool sewn = false;  ///< of flat panels: their shape at rest is `material` alone, and `rest` is where they start
  std::vector<Band> bands;
  std::vector<Tie> ties;
  std::vector<Reinforcement> reinforcements;  ///< per triangle; empty: none
};

/// Area of a triangle at rest [m²].
double rest_area(const Sheet& sheet, std::size_t triangle);

/// A sheet whose rest shape is the mesh. In each triangle the weft runs along x projected into it, in triangles across
/// x it runs along −z; for a flat mesh in the x-y plane weft and warp are x and y. Each triangle has coordinates of its
/// own: those of its neighbours differ from them by a rigid motion.
Sheet make_sheet_of(const Mesh& mesh);

/// Shortest height of a triangle at rest [m].
double height(const Sheet& sheet, std::size_t triangle);
/// The least of all [m].
double least_height(const Sheet& sheet);

/// Ways to cut each cell of a grid.
enum class Pattern {
  aligned,  ///< all along the diagonal from (0,0) to (1,1)
  crossed,  ///< along both, with a vertex in the middle
};

/// As make_sheet, of triangles; the middles of crossed cells come after the vertices of the grid.
Mesh make_triangle_sheet(const Grid& grid, Pattern pattern);

}  // namespace weft::mesh
