#include "physics/collision/hierarchy/traversal.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel_append.hpp"

namespace weft::collision {

namespace {

// A traversal without a separation list uses threads if both trees together have at least
// kMinLeavesForThreads leaves. (A tree that is traversed against itself counts twice.) The
// traversal is then divided into at least kMinThreadTasks tasks, if possible.
constexpr std::size_t kMinLeavesForThreads = 512, kMinThreadTasks = 64;

/// One traversal of two trees, which may be the same. kLonger: as Traversal::open_longer_side. kListed: records in a
/// separation list where the traversal stops. Both are template parameters, so that the usual traversal has no branches
/// for them.
template <int K, bool kLonger, bool kListed>
class Traverser {
 public:
  using TreeType = Tree<K>;
  using Ref = typename TreeType::Ref;
  using Leaf = typename TreeType::Leaf;
  using Node = typename TreeType::Node;

  Traverser(const TreeType& tree_a, const TreeType& tree_b, const Traversal& how, CandidatePairs& out)
      : a_(tree_a), b_(tree_b), same_(&tree_a == &tree_b), how_(how), out_(out) {}

  /// Lists all pairs, from the roots or from where the last traversal stopped.
  void run() {
    if constexpr (kListed) {
      SeparationList& list = *how_.list;
      if (list.needs_rebuild()) {
        list.restart();
        from_roots();
      } else {
        resume();
      }
      list.end_traversal();
    } else {
      from_roots_in_threads();
    }
  }

 private:
  static std::size_t index(Ref ref) { return static_cast<std::size_t>(ref); }

  /// Lists the same pairs as from_roots(), in the same order. Expands the traversal level by level
  /// into deferred calls, until there are at least kMinThreadTasks of them or no more can be
  /// expanded. Threads then share these calls.
  void from_roots_in_threads() {
    const bool is_large = a_.leaves().size() + b_.leaves().size() >= kMinLeavesForThreads;
    if (thread_count() == 1 || !is_large) {
      const CountedLoop counted(is_large ? kMinThreadTasks : 1);
      return from_roots();
    }
    std::vector<DeferredCall> stops, opened;
    deferred_ = &stops;
    from_roots();
    for (std::size_t before = 0; stops.size() < kMinThreadTasks && stops.size() != before;) {
      before = stops.size();
      opened.clear();
      deferred_ = &opened;
      for (const DeferredCall& stop : stops)
        if (stop.a < 0 && stop.b < 0)
          opened.push_back(stop);
        else
          resume_from(stop);
      std::swap(stops, opened);
    }
    deferred_ = nullptr;
    parallel_append(stops.size(), 1 + stops.size() / kMinThreadTasks, out_,
                    [&](std::size_t begin, std::size_t end, CandidatePairs& list) {
                      Traverser traverser(a_, b_, how_, list);
                      for (std::size_t s = begin; s < end; ++s) traverser.resume_from(stops[s]);
                    });
  }

  void from_roots() {
    if (same_) return traverse_self(a_.root());
    if (a_.bound(a_.root()).overlaps(b_.bound(b_.root()))) return traverse_pair(a_.root(), b_.root());
    // If the roots do not overlap, the separation list stays empty, so the next traversal also starts at the roots.
  }

  void resume() {
    SeparationList& list = *how_.list;
    if (list.size() + list.self_leaves.size() + list.closed.size() == 0) return from_roots();
    // Move the old entries, at which this traversal resumes, out of `list`, to which this traversal
    // adds new ones.
    SeparationList before;
    std::swap(before.missed, list.missed);
    std::swap(before.leaf_pairs, list.leaf_pairs);
    std::swap(before.self_leaves, list.self_leaves);
    std::swap(before.closed, list.closed);

    for (const Ref ref : before.self_leaves) test_self_leaf(a_.leaves()[index(~ref)]);
    for (const auto& [a, b] : before.leaf_pairs)
      test_leaf_pair(a_.leaves()[index(~a)], b_.leaves()[index(~b)], b_.bound(b));
    std::size_t kept = 0;
    for (SeparationList::Missed stop : before.missed) {
      const TreeType &query_tree = stop.query_in_a ? a_ : b_, &node_tree = stop.query_in_a ? b_ : a_;
      const Node& node = node_tree.nodes()[index(stop.node)];
      const std::uint32_t hits = overlap_mask(node.bounds, query_tree.bound(stop.query).row, 1) & stop.lanes;
      for_each_bit(hits, [&](int i) {
        if (stop.query_in_a)
          traverse_pair(stop.query, node.child[i]);
        else
          traverse_pair(node.child[i], stop.query);
      });
      stop.lanes = static_cast<std::uint16_t>(stop.lanes & ~hits);
      if (stop.lanes != 0) before.missed[kept++] = stop;
    }
    before.missed.resize(kept);
    for (const Ref ref : before.closed) traverse_self(ref);  // adds new entries for this subtree

    // Append the new entries to the old ones and not the reverse, so that the old ones are not copied.
    const auto append = [](auto& first, auto& second) {
      first.insert(first.end(), second.begin(), second.end());
      std::swap(first, second);
    };
    append(before.missed, list.missed);
    append(before.leaf_pairs, list.leaf_pairs);
    append(before.self_leaves, list.self_leaves);
  }

  /// A call of open() that is done later: open(a) if `self`, else open(a, b).
  struct DeferredCall {
    Ref a, b;
    bool self;
  };
  void resume_from(const DeferredCall& stop) { stop.self ? open(stop.a) : open(stop.a, stop.b); }

  /// Lists all pairs of triangles below one node of a tree that is traversed against itself.
  void traverse_self(Ref ref) {
    if (deferred_ != nullptr) return deferred_->push_back({ref, ref, true});
    open(ref);
  }
  void open(Ref ref) {
    if (how_.regions != nullptr && how_.regions->has_nothing_near(ref)) {
      if constexpr (kListed) how_.list->closed.push_back(ref);
      return;
    }
    if (ref < 0) {
      if constexpr (kListed) how_.list->self_leaves.push_back(ref);
      return test_self_leaf(a_.leaves()[index(~ref)]);
    }
    const Node& node = a_.nodes()[index(ref)];
    for (int i = 0; i < node.count; ++i) {
      traverse_self(node.child[i]);
      const std::uint32_t later = first_lanes(node.count) & ~first_lanes(i + 1);
      const std::uint32_t hits = overlap_mask(node.bounds, &node.bounds.row[0][i], kLanes) & later;
      record_miss(node.child[i], ref, later & ~hits, true);
      for_each_bit(hits, [&](int j) { traverse_pair(node.child[i], node.child[j]); });
    }
  }

  /// Lists all pairs of a triangle below ref_a and one below ref_b. The bounds of ref_a and ref_b
  /// must overlap. Unless kLonger, descends into both nodes, because overlap_mask() compares a bound
  /// with all children of a node at once (SIMD).
  void traverse_pair(Ref ref_a, Ref ref_b) {
    if (deferred_ != nullptr) return deferred_->push_back({ref_a, ref_b, false});
    open(ref_a, ref_b);
  }
  void open(Ref ref_a, Ref ref_b) {
    if (ref_a < 0 && ref_b < 0) {
      if constexpr (kListed) how_.list->leaf_pairs.push_back({ref_a, ref_b});
      return test_leaf_pair(a_.leaves()[index(~ref_a)], b_.leaves()[index(~ref_b)], b_.bound(ref_b));
    }
    if (ref_a < 0 || (kLonger && ref_b >= 0 && b_.bound(ref_b).longest_side() > a_.bound(ref_a).longest_side()))
      return open_b(ref_a, a_.bound(ref_a).row, 1, ref_b);
    const Node& node_a = a_.nodes()[index(ref_a)];
    const std::uint32_t hits_a = overlap_mask(node_a.bounds, b_.bound(ref_b).row, 1) & first_lanes(node_a.count);
    record_miss(ref_b, ref_a, first_lanes(node_a.count) & ~hits_a, false);
    for_each_bit(hits_a, [&](int i) {
      if (kLonger || ref_b < 0)
        traverse_pair(node_a.child[i], ref_b);
      else
        open_b(node_a.child[i], &node_a.bounds.row[0][i], kLanes, ref_b);
    });
  }

  /// Tests ref_a against all children of a node of tree b. Row r of the bound of ref_a is row[r * stride].
  void open_b(Ref ref_a, const float* row, std::size_t stride, Ref ref_b) {
    const Node& node = b_.nodes()[index(ref_b)];
    const std::uint32_t hits = overlap_mask(node.bounds, row, stride) & first_lanes(node.count);
    record_miss(ref_a, ref_b, first_lanes(node.count) & ~hits, true);
    for_each_bit(hits, [&](int j) { traverse_pair(ref_a, node.child[j]); });
  }

  void record_miss(Ref query, Ref node, std::uint32_t lanes, bool query_in_a) {
    if constexpr (kListed)
      if (lanes != 0) how_.list->missed.push_back({query, node, static_cast<std::uint16_t>(lanes), query_in_a});
  }

  void test_self_leaf(const Leaf& leaf) {
    for (int i = 0; i + 1 < leaf.count; ++i) test_lane(leaf, i, leaf, first_lanes(leaf.count) & ~first_lanes(i + 1));
  }

  void test_leaf_pair(const Leaf& leaf_a, const Leaf& leaf_b, const MovingKDop<K>& bound_b) {
    const std::uint32_t near_b = overlap_mask(leaf_a.bounds, bound_b.row, 1) & first_lanes(leaf_a.count);
    for_each_bit(near_b, [&](int i) { test_lane(leaf_a, i, leaf_b, first_lanes(leaf_b.count)); });
  }

  /// Tests triangle i of leaf a against the triangles of leaf b in the mask `allowed`.
  void test_lane(const Leaf& leaf_a, int i, const Leaf& leaf_b, std::uint32_t allowed) {
    const std::uint32_t hits = overlap_mask(leaf_b.bounds, &leaf_a.bounds.row[0][i], kLanes) & allowed;
    if (hits == 0) return;
    const SharedMasks shared = shared_vertices(leaf_b.corners, leaf_a.corners, i);
    append(out_.apart, leaf_a.triangle[i], leaf_b, hits & ~shared.one & ~shared.more);
    if (how_.one_shared) append(out_.one_shared, leaf_a.triangle[i], leaf_b, hits & shared.one);
  }

  void append(PairList& list, Index a, const Leaf& leaf_b, std::uint32_t mask) {
    TrianglePair* end = list.reserve_more(kLanes);
    for_each_bit(mask, [&](int j) {
      const Index b = leaf_b.triangle[j];
      *end++ = same_ && b < a ? TrianglePair{b, a} : TrianglePair{a, b};
    });
    list.grow(end);
  }

  const TreeType& a_;
  const TreeType& b_;
  const bool same_;
  const Traversal how_;
  CandidatePairs& out_;
  std::vector<DeferredCall>* deferred_ = nullptr;  // not null: collects calls of open() instead of making them
};

template <int K>
void walk(const Tree<K>& a, const Tree<K>& b, CandidatePairs& out, const Traversal& how) {
  if (a.empty() || b.empty()) return;
  if (how.open_longer_side)
    how.list != nullptr ? Traverser<K, true, true>(a, b, how, out).run()
                        : Traverser<K, true, false>(a, b, how, out).run();
  else
    how.list != nullptr ? Traverser<K, false, true>(a, b, how, out).run()
                        : Traverser<K, false, false>(a, b, how, out).run();
}

}  // namespace

template <int K>
void self_pairs(const Tree<K>& tree, CandidatePairs& out, const Traversal& how) {
  walk(tree, tree, out, how);
}

template <int K>
void pairs(const Tree<K>& tree_a, const Tree<K>& tree_b, CandidatePairs& out, const Traversal& how) {
  walk(tree_a, tree_b, out, how);
}

#define WEFT_INSTANTIATE(K)                                                    \
  template void self_pairs(const Tree<K>&, CandidatePairs&, const Traversal&); \
  template void pairs(const Tree<K>&, const Tree<K>&, CandidatePairs&, const Traversal&);
WEFT_INSTANTIATE(6)
WEFT_INSTANTIATE(18)
WEFT_INSTANTIATE(26)
#undef WEFT_INSTANTIATE

}  // namespace weft::collision
