// Which triangles of one surface are near a place: queries of a single hierarchy.
#pragma once

#include <functional>
#include <vector>

#include "collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Squared distance of a triangle, by its global number, from the place that is asked about [m²]; infinite where the
/// triangle is not to count.
using DistanceSq = std::function<double(Index)>;

/// Triangles are as near as the nearest one if their squared distance is no larger by more than this part.
inline constexpr double kAsNear = 1e-6;

/// Replaces `out` by the triangles, sorted by number, whose distance from p is least or as near as that; by none where
/// no triangle counts. Branch and bound: what is below a bound that is farther than the best so far is not looked at.
/// Triangles must lie inside their bounds; bounds that are too large only cost time.
template <int K>
void nearest_triangles(const Tree<K>& tree, const Vec3& p, const DistanceSq& distance_sq, std::vector<Index>& out);

/// Replaces `out` by the triangles, sorted by number, the boxes of whose bounds meet the one from `low` to `high` [m].
template <int K>
void triangles_in_box(const Tree<K>& tree, const Vec3& low, const Vec3& high, std::vector<Index>& out);

}  // namespace weft::collision
