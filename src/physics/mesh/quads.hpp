// Regular sheets, and the split of quads into triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/mesh/mesh.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// The two triangles of a quad, cut along the first diagonal (corner 0 to 2) or the second (corner 1 to 3).
inline std::array<Triangle, 2> split_quad(const Quad& q, bool first_diagonal) {
  if (first_diagonal) return {Triangle{q[0], q[1], q[2]}, Triangle{q[0], q[2], q[3]}};
  return {Triangle{q[0], q[1], q[3]}, Triangle{q[1], q[2], q[3]}};
}

/// Splits each quad along the diagonal that lies inside it. If both diagonals or neither lie inside, uses the shorter
/// one; if both are equally long, the first. Quad q gives triangles 2q and 2q + 1.
std::vector<Triangle> split_quads(std::span<const Quad> quads, std::span<const Vec3> positions);

/// Sheet of nu × nv particles in the x-y plane, centred on the origin: weft along x, warp along y, front toward +z.
/// `uv` are the rest coordinates of column and row [m]. The diagonal alternates from quad to quad, so that no bias
/// direction is preferred.
Mesh make_sheet(const Grid& grid);

}  // namespace weft::mesh
