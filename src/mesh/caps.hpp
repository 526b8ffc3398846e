// Lids on the holes of a surface that parts have been taken from.
#pragma once

#include <span>
#include <vector>

#include "mesh/topology.hpp"

namespace weft::mesh {

/// Appends to `kept`, some of the triangles of `whole`, those that close the borders which the others left behind; a
/// border of `whole` stays open. No vertex is added. Where borders meet in a vertex, each ring ends where it comes back
/// to one of its own vertices. Time O(n log n) and that of triangulate_polygon().
void close_cuts(std::span<const Triangle> whole, std::span<const Vec3> positions, std::vector<Triangle>& kept);

}  // namespace weft::mesh
