// Splits a set of triangles in two while a hierarchy is built.
#pragma once

#include <span>

#include "core/types.hpp"
#include "physics/collision/hierarchy/kdop.hpp"

namespace weft::collision {

/// Splits the triangles `items` (indices into `bounds`) by a plane through the centre of their common k-DOP. The plane
/// is parallel to that pair of opposite faces of the k-DOP which are furthest apart. A triangle that the plane cuts
/// goes to the part with fewer uncut triangles (Etzmuß et al. 2001, "Bounding Volume Hierarchy"). If one part would be
/// empty, each part gets half of the items. Reorders `items` so that the first part comes first, keeps the order within
/// each part, and returns the size of the first part. Needs at least two items.
template <int K>
std::size_t split_longest_side(std::span<Index> items, std::span<const KDop<K>> bounds);

}  // namespace weft::collision
