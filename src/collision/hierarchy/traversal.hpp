// Which triangles may be close: walks one or two hierarchies and lists the pairs with overlapping bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/hierarchy/separation_list.hpp"
#include "collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Subtrees of one tree in which no two features without a common vertex are near (see normal_cones.hpp).
struct Regions {
  std::vector<std::uint8_t> node, leaf;  ///< 1 where nothing is near, by number

  bool nothing_near(std::int32_t ref) const { return (ref >= 0 ? node[ref] : leaf[~ref]) != 0; }
};

/// How to walk; none of it changes what is found, except that pairs inside `regions` are left out, and those that share
/// a vertex where they are not wanted.
struct Traversal {
  /// Of two overlapping nodes, open the one with the longer k-DOP side only (seed, "Detection Process").
  bool open_longer_side = false;
  /// Resume where the list stopped, and note in it where this walk stops. One list per pair of trees.
  SeparationList* list = nullptr;
  const Regions* regions = nullptr;
  /// List pairs that share one vertex, too.
  bool one_shared = true;
};

/// Appends all pairs of different triangles of one surface whose bounds overlap, except those sharing an edge or more.
/// Every pair appears once, a < b; the order depends on the tree and, with a separation list, on its earlier walks.
template <int K>
void self_pairs(const Tree<K>& tree, CandidatePairs& out, const Traversal& how = {});

/// Appends all pairs (a of tree a, b of tree b) whose bounds overlap, except those sharing an edge or more.
template <int K>
void pairs(const Tree<K>& tree_a, const Tree<K>& tree_b, CandidatePairs& out, const Traversal& how = {});

}  // namespace weft::collision
