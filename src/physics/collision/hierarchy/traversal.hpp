// Traverses one or two hierarchies and lists the pairs of triangles with overlapping bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/collision/hierarchy/tree.hpp"
#include "physics/collision/variants/separation_list.hpp"

namespace weft::collision {

/// Subtrees of one tree in which no two features without a common vertex are near (see normal_cones.hpp).
struct Regions {
  std::vector<std::uint8_t> node, leaf;  ///< by number; 1: nothing is near

  bool has_nothing_near(std::int32_t ref) const { return (ref >= 0 ? node[ref] : leaf[~ref]) != 0; }
};

/// How to traverse. The options do not change which pairs are found, except that pairs inside `regions` are skipped,
/// and pairs that share one vertex if `one_shared` is false.
struct Traversal {
  /// Of two overlapping nodes, descend only into the one with the longer k-DOP side (Etzmuß et al. 2001, "Detection
  /// Process").
  bool open_longer_side = false;
  /// Resume where the last traversal stopped, and record where this one stops. One list per pair of trees.
  SeparationList* list = nullptr;
  const Regions* regions = nullptr;
  /// Also list pairs that share one vertex.
  bool one_shared = true;
};

/// Appends all pairs of different triangles of one surface whose bounds overlap, except pairs that share an edge or
/// more. Every pair appears once, with a < b. The order depends on the tree and on the separation list.
template <int K>
void self_pairs(const Tree<K>& tree, CandidatePairs& out, const Traversal& how = {});

/// Appends all pairs (a of tree a, b of tree b) whose bounds overlap, except pairs that share an edge or more.
template <int K>
void pairs(const Tree<K>& tree_a, const Tree<K>& tree_b, CandidatePairs& out, const Traversal& how = {});

}  // namespace weft::collision
