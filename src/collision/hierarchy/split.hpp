// Where to cut a set of triangles in two while a hierarchy is built.
#pragma once

#include <span>

#include "collision/hierarchy/kdop.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Cuts `items` (indices into `bounds`) in two by the longest side: the pair of opposite faces of their k-DOP that are
/// furthest apart is split through its centre; a triangle that the plane cuts goes to the side with fewer uncut ones
/// (seed, "Bounding Volume Hierarchy"). Reorders items, keeping the order within a side, and returns the size of the
/// first side; both are non-empty. Needs at least two items.
template <int K>
std::size_t split_longest_side(std::span<Index> items, std::span<const KDop<K>> bounds);

}  // namespace weft::collision
