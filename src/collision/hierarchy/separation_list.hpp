// Where the walk over two hierarchies stopped last time (Li & Chen, "Incremental 3D collision detection with
// hierarchical data structures", 1998; seed, "Detection Process").
#pragma once

#include <cstdint>
#include <vector>

namespace weft::collision {

/// Pairs of subtrees that cover all pairs of triangles between two trees, or of one tree with itself. Each stays valid
/// whatever the bounds become, so a walk may begin here instead of at the roots. Entries only move down: one whose
/// bounds have come to overlap is replaced by those below it. One that could move up again costs an overlap test per
/// walk until the list is rebuilt, which is due
///   - after kWalks walks, or
///   - once it has grown by half.
/// Both limits are chosen, not tuned: they bound the useless tests to about half of the useful ones.
class SeparationList {
 public:
  using Ref = std::int32_t;  ///< node (≥ 0) or leaf ~ref (< 0), as in Tree

  /// Subtree `query` of one tree missed the children `lanes` (bits) of inner node `node` of the other.
  struct Missed {
    Ref query, node;
    std::uint16_t lanes;
    bool query_in_a;
  };

  /// Two leaves whose bounds overlapped.
  struct LeafPair {
    Ref a, b;
  };

  static constexpr int kWalks = 64;

  bool due() const { return walks_ == 0 || walks_ >= kWalks || 2 * size() > 3 * size_when_built_; }
  std::size_t size() const { return missed.size() + leaf_pairs.size(); }

  /// Empties the list for a walk from the roots.
  void restart() {
    missed.clear();
    leaf_pairs.clear();
    self_leaves.clear();
    closed.clear();
    walks_ = 0;
  }
  /// Called at the end of each walk.
  void walked() {
    if (walks_++ == 0) size_when_built_ = size();
  }

  std::vector<Missed> missed;
  std::vector<LeafPair> leaf_pairs;
  std::vector<Ref> self_leaves;  ///< leaves tested with themselves
  std::vector<Ref> closed;       ///< subtrees not opened against themselves because nothing in them was near

 private:
  int walks_ = 0;
  std::size_t size_when_built_ = 0;
};

}  // namespace weft::collision
