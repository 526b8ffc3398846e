#include "collision/hierarchy/traversal.hpp"

#include <algorithm>
#include <bit>

namespace weft::collision {

namespace {

/// The lanes below `count`.
std::uint32_t first_lanes(int count) {
  return (1U << count) - 1;
}

/// Calls visit(l) for each set bit, lowest first.
template <class Visit>
void for_each_bit(std::uint32_t mask, const Visit& visit) {
  for (; mask != 0; mask &= mask - 1) visit(std::countr_zero(mask));
}

/// One walk over the trees of both sides, which may be the same one.
template <int K, int Arity>
class Walk {
 public:
  using TreeType = Tree<K, Arity>;
  using Ref = typename TreeType::Ref;
  using Leaf = typename TreeType::Leaf;
  using Node = typename TreeType::Node;

  Walk(const TreeType& tree_a, const TreeType& tree_b, CandidatePairs& out)
      : a_(tree_a), b_(tree_b), same_(&tree_a == &tree_b), out_(out) {}

  /// All pairs below one node of a single tree.
  void self(Ref ref) {
    if (ref < 0) return self_leaf(a_.leaves()[index(~ref)]);
    const Node& node = a_.nodes()[index(ref)];
    for (int i = 0; i < node.count; ++i) {
      self(node.child[i]);
      const std::uint32_t later = first_lanes(node.count) & ~first_lanes(i + 1);
      const std::uint32_t hits = overlap_mask(node.bounds, &node.bounds.row[0][i], Arity) & later;
      for_each_bit(hits, [&](int j) { both(node.child[i], node.child[j]); });
    }
  }

  /// All pairs of something below ref_a with something below ref_b, whose bounds are known to overlap. Two nodes are
  /// opened together: one test against all children costs as much as one against a single child, so the choice of
  /// the longer one (seed) does not pay here.
  void both(Ref ref_a, Ref ref_b) {
    if (ref_a < 0 && ref_b < 0) return leaves(a_.leaves()[index(~ref_a)], b_.leaves()[index(~ref_b)], b_.bound(ref_b));
    if (ref_a < 0) {
      const Node& node = b_.nodes()[index(ref_b)];
      const std::uint32_t hits = overlap_mask(node.bounds, a_.bound(ref_a).row, 1) & first_lanes(node.count);
      return for_each_bit(hits, [&](int j) { both(ref_a, node.child[j]); });
    }
    const Node& node_a = a_.nodes()[index(ref_a)];
    const std::uint32_t hits_a = overlap_mask(node_a.bounds, b_.bound(ref_b).row, 1) & first_lanes(node_a.count);
    if (ref_b < 0) return for_each_bit(hits_a, [&](int i) { both(node_a.child[i], ref_b); });
    const Node& node_b = b_.nodes()[index(ref_b)];
    for_each_bit(hits_a, [&](int i) {
      const std::uint32_t hits =
          overlap_mask(node_b.bounds, &node_a.bounds.row[0][i], Arity) & first_lanes(node_b.count);
      for_each_bit(hits, [&](int j) { both(node_a.child[i], node_b.child[j]); });
    });
  }

 private:
  static std::size_t index(Ref ref) { return static_cast<std::size_t>(ref); }

  void self_leaf(const Leaf& leaf) {
    for (int i = 0; i + 1 < leaf.count; ++i) lane(leaf, i, leaf, first_lanes(leaf.count) & ~first_lanes(i + 1));
  }

  void leaves(const Leaf& leaf_a, const Leaf& leaf_b, const KDop<K>& bound_b) {
    const std::uint32_t near_b = overlap_mask(leaf_a.bounds, bound_b.row, 1) & first_lanes(leaf_a.count);
    for_each_bit(near_b, [&](int i) { lane(leaf_a, i, leaf_b, first_lanes(leaf_b.count)); });
  }

  /// Triangle i of leaf a against the `allowed` ones of leaf b.
  void lane(const Leaf& leaf_a, int i, const Leaf& leaf_b, std::uint32_t allowed) {
    const std::uint32_t hits = overlap_mask(leaf_b.bounds, &leaf_a.bounds.row[0][i], kLeafLanes) & allowed;
    if (hits == 0) return;
    const SharedMasks shared = shared_vertices(leaf_b.corners, leaf_a.corners, i);
    append(out_.apart, leaf_a.triangle[i], leaf_b, hits & ~shared.one & ~shared.more);
    append(out_.one_shared, leaf_a.triangle[i], leaf_b, hits & shared.one);
  }

  void append(PairList& list, Index a, const Leaf& leaf_b, std::uint32_t mask) {
    TrianglePair* end = list.reserve_more(kLeafLanes);
    for_each_bit(mask, [&](int j) {
      const Index b = leaf_b.triangle[j];
      *end++ = same_ && b < a ? TrianglePair{b, a} : TrianglePair{a, b};
    });
    list.grow(end);
  }

  const TreeType& a_;
  const TreeType& b_;
  const bool same_;
  CandidatePairs& out_;
};

}  // namespace

template <int K, int Arity>
void self_pairs(const Tree<K, Arity>& tree, CandidatePairs& out) {
  if (!tree.empty()) Walk<K, Arity>(tree, tree, out).self(tree.root());
}

template <int K, int Arity>
void pairs(const Tree<K, Arity>& tree_a, const Tree<K, Arity>& tree_b, CandidatePairs& out) {
  if (tree_a.empty() || tree_b.empty() || !tree_a.bound(tree_a.root()).overlaps(tree_b.bound(tree_b.root()))) return;
  Walk<K, Arity>(tree_a, tree_b, out).both(tree_a.root(), tree_b.root());
}

#define WEFT_INSTANTIATE(K, Arity)                                  \
  template void self_pairs(const Tree<K, Arity>&, CandidatePairs&); \
  template void pairs(const Tree<K, Arity>&, const Tree<K, Arity>&, CandidatePairs&);
WEFT_INSTANTIATE(6, 2)
WEFT_INSTANTIATE(6, 4)
WEFT_INSTANTIATE(6, 8)
WEFT_INSTANTIATE(14, 2)
WEFT_INSTANTIATE(14, 4)
WEFT_INSTANTIATE(14, 8)
WEFT_INSTANTIATE(18, 2)
WEFT_INSTANTIATE(18, 4)
WEFT_INSTANTIATE(18, 8)
WEFT_INSTANTIATE(26, 2)
WEFT_INSTANTIATE(26, 4)
WEFT_INSTANTIATE(26, 8)
#undef WEFT_INSTANTIATE

}  // namespace weft::collision
