// Queries of a single hierarchy: the triangles of one surface near a point or in a box.
#pragma once

#include <functional>
#include <vector>

#include "physics/collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Returns the squared distance [m²] of a triangle (by global number) from the query point, or infinity to exclude the
/// triangle.
using DistanceSq = std::function<double(Index)>;

/// A triangle counts as nearest if its squared distance exceeds the smallest one by at most this fraction.
inline constexpr double kNearestTolerance = 1e-6;

/// Replaces `out` by the triangles nearest to p (within kNearestTolerance), sorted by number. `out` is empty if
/// `distance_sq` excludes all. Branch and bound: skips subtrees whose bounds are farther than the best triangle so far.
/// At the positions that `distance_sq` uses, each triangle must lie inside its bound of the last refit. A bound that is
/// larger than necessary only costs time.
template <int K>
void nearest_triangles(const Tree<K>& tree, const Vec3& p, const DistanceSq& distance_sq, std::vector<Index>& out);

/// Replaces `out` by the triangles whose boxes overlap the box from `low` to `high` [m], sorted by number. The box of a
/// triangle contains its whole motion of the last refit, enlarged by the margin of that refit.
template <int K>
void triangles_in_box(const Tree<K>& tree, const Vec3& low, const Vec3& high, std::vector<Index>& out);

}  // namespace weft::collision
