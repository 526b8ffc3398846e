// Cloth of triangles: its rest shape in material coordinates, and regular sheets.
#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/topology.hpp"

namespace weft::mesh {

/// Rest shape of cloth made of triangles, flat or not.
struct Sheet {
  std::vector<Triangle> triangles;            ///< manifold and equally oriented
  std::vector<Vec3> rest;                     ///< per vertex [m]
  std::vector<std::array<Vec2, 3>> material;  ///< (weft, warp) of each triangle's corners, counter-clockwise [m]
};

/// A sheet whose rest shape is the mesh. In each triangle the weft runs along x projected into it, in triangles across
/// x it runs along −z; for a flat mesh in the x-y plane weft and warp are x and y. Each triangle has coordinates of its
/// own: those of its neighbours differ from them by a rigid motion.
Sheet make_sheet_of(const Mesh& mesh);

/// Shortest height of a triangle [m].
double least_height(const Sheet& sheet);

/// Ways to cut each cell of a grid.
enum class Pattern {
  aligned,  ///< all along the diagonal from (0,0) to (1,1)
  crossed,  ///< along both, with a vertex in the middle
};

/// As make_sheet, of triangles; the middles of crossed cells come after the vertices of the grid.
Mesh make_triangle_sheet(const Grid& grid, Pattern pattern);

}  // namespace weft::mesh
