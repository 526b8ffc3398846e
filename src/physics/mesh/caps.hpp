// Closes a surface from which some triangles have been removed.
#pragma once

#include <span>
#include <vector>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Appends lid triangles to `kept`, a subset of the triangles of `whole`. A lid closes a ring of
/// edges at which triangles were removed. Borders of `whole` itself stay open, and so does a cut
/// that runs from border to border of `whole`. Adds no vertices. Rings that share a vertex get
/// separate lids. Time O(n log n + b²) for n triangles and b border edges, plus that of
/// triangulate_polygon().
void close_cuts(std::span<const Triangle> whole, std::span<const Vec3> positions, std::vector<Triangle>& kept);

}  // namespace weft::mesh
