// Records where the last traversal of one or two hierarchies stopped (Li & Chen, "Incremental 3D collision detection
// with hierarchical data structures", 1998).
#pragma once

#include <cstdint>
#include <vector>

namespace weft::collision {

/// Pairs of subtrees at which the last traversal stopped. Together they cover all pairs of triangles between two trees,
/// or within one tree, whatever the bounds become. So a traversal may start from them instead of the roots. If the
/// bounds of an entry overlap now, entries for its children replace it. Entries for parents never replace those for
/// children: an entry that is deeper in the tree than necessary costs one overlap test per traversal until the list is
/// rebuilt. A rebuild is due after kMaxTraversals traversals, or once the list has grown by more than half.
class SeparationList {
 public:
  using Ref = std::int32_t;  ///< node number (≥ 0) or ~leaf number (< 0), as in Tree

  /// Subtree `query` of one tree does not overlap some children of the inner node `node` of the other tree (of the same
  /// tree if it is traversed against itself): those whose bits are set in `lanes`. `query_in_a`: `query` belongs to
  /// tree a.
  struct Missed {
    Ref query, node;
    std::uint16_t lanes;
    bool query_in_a;
  };

  /// Two leaves whose bounds overlapped when the entry was added.
  struct LeafPair {
    Ref a, b;
  };

  static constexpr int kMaxTraversals = 64;

  bool needs_rebuild() const {
    return traversals_ == 0 || traversals_ >= kMaxTraversals || 2 * size() > 3 * size_when_built_;
  }
  std::size_t size() const { return missed.size() + leaf_pairs.size(); }

  /// Empties the list before a traversal from the roots.
  void restart() {
    missed.clear();
    leaf_pairs.clear();
    self_leaves.clear();
    closed.clear();
    traversals_ = 0;
  }
  /// Call at the end of each traversal.
  void end_traversal() {
    if (traversals_++ == 0) size_when_built_ = size();
  }

  std::vector<Missed> missed;
  std::vector<LeafPair> leaf_pairs;
  std::vector<Ref> self_leaves;  ///< leaves tested with themselves
  std::vector<Ref> closed;       ///< flat regions (NormalCones), which are not tested with themselves

 private:
  int traversals_ = 0;
  std::size_t size_when_built_ = 0;
};

}  // namespace weft::collision
