// Which triangles may be close: walks one or two hierarchies and lists the pairs with overlapping bounds.
#pragma once

#include "collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Appends all pairs of different triangles of one surface whose bounds overlap, except those sharing an edge or more.
/// Every pair appears once, a < b; the order depends on the tree alone.
template <int K, int Arity>
void self_pairs(const Tree<K, Arity>& tree, CandidatePairs& out);

/// Appends all pairs (a of tree a, b of tree b) whose bounds overlap, except those sharing an edge or more.
template <int K, int Arity>
void pairs(const Tree<K, Arity>& tree_a, const Tree<K, Arity>& tree_b, CandidatePairs& out);

}  // namespace weft::collision
