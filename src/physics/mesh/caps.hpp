// Closes a surface from which some triangles have been removed.
#pragma once

#include <span>
#include <vector>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Appends lid triangles to `kept`, a subset of the triangles of `whole`. The lids close the borders that the removed
/// triangles left behind; a border of `whole` itself stays open. Adds no vertices. Each lid fills a ring of border
/// edges. A path along the border closes a ring as soon as it reaches one of its vertices again, so borders that share
/// a vertex get several lids. Time O(n log n + b²) for n triangles and b border edges, plus that of
/// triangulate_polygon().
void close_cuts(std::span<const Triangle> whole, std::span<const Vec3> positions, std::vector<Triangle>& kept);

}  // namespace weft::mesh
