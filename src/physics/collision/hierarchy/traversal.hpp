// Traverses one or two hierarchies and lists the pairs of triangles with overlapping bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/collision/hierarchy/tree.hpp"
#include "physics/collision/variants/separation_list.hpp"

namespace weft::collision {

/// Flags the subtrees of one tree in which no two features (vertices, edges, faces) without a common vertex are near,
/// that is, closer than the detection distance (see normal_cones.hpp).
struct Regions {
  std::vector<std::uint8_t> node, leaf;  ///< by number; 1: nothing is near

  bool has_nothing_near(std::int32_t ref) const { return (ref >= 0 ? node[ref] : leaf[~ref]) != 0; }
};

/// Options of a traversal. Only `regions` and `one_shared` change which pairs are found.
struct Traversal {
  /// Of two nodes that overlap, descend only into the one with the longer k-DOP side (Etzmuß et al. 2001, "Detection
  /// Process").
  bool open_longer_side = false;
  /// If not null: resume where the last traversal with this list stopped, and record where this one
  /// stops. Each pair of trees needs its own list.
  SeparationList* list = nullptr;
  const Regions* regions = nullptr;  ///< self_pairs() skips pairs inside these regions; null: skips none
  /// Also list pairs with one common vertex.
  bool one_shared = true;
};

/// Appends all pairs of different triangles of one surface whose bounds overlap, except pairs with two or more common
/// vertices. Every pair appears once, with a < b. The order depends on the tree and on the separation list.
template <int K>
void self_pairs(const Tree<K>& tree, CandidatePairs& out, const Traversal& how = {});

/// Appends all pairs (a of tree a, b of tree b) whose bounds overlap, except pairs with two or more common vertices.
template <int K>
void pairs(const Tree<K>& tree_a, const Tree<K>& tree_b, CandidatePairs& out, const Traversal& how = {});

}  // namespace weft::collision
