// Splits a set of triangles in two while a hierarchy is built.
#pragma once

#include <span>

#include "core/types.hpp"
#include "physics/collision/hierarchy/kdop.hpp"

namespace weft::collision {

/// Splits `items` (indices into `bounds`) at the plane through the centre of their k-DOP that is parallel to the two
/// opposite faces furthest apart, as in the seed (the paper that README.md names; "Bounding Volume Hierarchy"). A
/// triangle that the plane cuts goes to the part with fewer uncut triangles. If one part would be empty, each gets half
/// of the items. Reorders items, keeping the order within a part, and returns the size of the first part. Needs at
/// least two items.
template <int K>
std::size_t split_longest_side(std::span<Index> items, std::span<const KDop<K>> bounds);

}  // namespace weft::collision
