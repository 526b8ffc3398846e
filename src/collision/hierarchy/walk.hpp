// The recursion over one or two hierarchies; internal to traversal.cpp.
#pragma once

#include <algorithm>
#include <utility>

#include "collision/hierarchy/traversal.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {

// Leaves of both trees from which threads are worth their while; and calls that these are cut into at least.
constexpr std::size_t kLeavesForThreads = 512, kStopsForThreads = 64;

/// One walk over the trees of both sides, which may be the same one. kLonger: of two nodes only the one with the longer
/// side is opened. kListed: stops are noted in a separation list. Both are fixed at compile time so that the plain walk
/// does not ask.
template <int K, bool kLonger, bool kListed>
class Walk {
 public:
  using TreeType = Tree<K>;
  using Ref = typename TreeType::Ref;
  using Leaf = typename TreeType::Leaf;
  using Node = typename TreeType::Node;

  Walk(const TreeType& tree_a, const TreeType& tree_b, const Traversal& how, CandidatePairs& out)
      : a_(tree_a), b_(tree_b), same_(&tree_a == &tree_b), how_(how), out_(out) {}

  /// All pairs from the roots, or from where the last walk stopped.
  void run() {
    if constexpr (kListed) {
      SeparationList& list = *how_.list;
      if (list.due()) {
        list.restart();
        from_roots();
      } else {
        resume();
      }
      list.walked();
    } else {
      from_roots_in_threads();
    }
  }

 private:
  static std::size_t index(Ref ref) { return static_cast<std::size_t>(ref); }

  /// What from_roots() lists, in the same order: trees are opened until there is enough for threads to go on from.
  void from_roots_in_threads() {
    if (thread_count() == 1 || a_.leaves().size() + b_.leaves().size() < kLeavesForThreads) return from_roots();
    std::vector<Stop> stops, opened;
    stops_ = &stops;
    from_roots();
    for (std::size_t before = 0; stops.size() < kStopsForThreads && stops.size() != before;) {
      before = stops.size();
      opened.clear();
      stops_ = &opened;
      for (const Stop& stop : stops)
        if (stop.a < 0 && stop.b < 0)
          opened.push_back(stop);
        else
          go_on_from(stop);
      std::swap(stops, opened);
    }
    stops_ = nullptr;
    parallel_append(stops.size(), 1 + stops.size() / kStopsForThreads, out_,
                    [&](std::size_t begin, std::size_t end, CandidatePairs& list) {
                      Walk walk(a_, b_, how_, list);
                      for (std::size_t s = begin; s < end; ++s) walk.go_on_from(stops[s]);
                    });
  }

  void from_roots() {
    if (same_) return self(a_.root());
    if (a_.bound(a_.root()).overlaps(b_.bound(b_.root()))) return both(a_.root(), b_.root());
    // Nothing is noted: the next walk begins at the roots as well.
  }

  void resume() {
    SeparationList& list = *how_.list;
    if (list.size() + list.self_leaves.size() + list.closed.size() == 0) return from_roots();
    // What this walk adds is taken apart from what it resumes.
    SeparationList before;
    std::swap(before.missed, list.missed);
    std::swap(before.leaf_pairs, list.leaf_pairs);
    std::swap(before.self_leaves, list.self_leaves);
    std::swap(before.closed, list.closed);

    for (const Ref ref : before.self_leaves) self_leaf(a_.leaves()[index(~ref)]);
    for (const auto& [a, b] : before.leaf_pairs) leaves(a_.leaves()[index(~a)], b_.leaves()[index(~b)], b_.bound(b));
    std::size_t kept = 0;
    for (SeparationList::Missed stop : before.missed) {
      const TreeType &query_tree = stop.query_in_a ? a_ : b_, &node_tree = stop.query_in_a ? b_ : a_;
      const Node& node = node_tree.nodes()[index(stop.node)];
      const std::uint32_t hits = overlap_mask(node.bounds, query_tree.bound(stop.query).row, 1) & stop.lanes;
      for_each_bit(hits, [&](int i) {
        if (stop.query_in_a)
          both(stop.query, node.child[i]);
        else
          both(node.child[i], stop.query);
      });
      stop.lanes = static_cast<std::uint16_t>(stop.lanes & ~hits);
      if (stop.lanes != 0) before.missed[kept++] = stop;
    }
    before.missed.resize(kept);
    for (const Ref ref : before.closed) self(ref);

    // Old entries stay in front, so that they are not copied again and again.
    const auto append = [](auto& first, auto& second) {
      first.insert(first.end(), second.begin(), second.end());
      std::swap(first, second);
    };
    append(before.missed, list.missed);
    append(before.leaf_pairs, list.leaf_pairs);
    append(before.self_leaves, list.self_leaves);
    append(before.closed, list.closed);
  }

  /// A call that is put off.
  struct Stop {
    Ref a, b;
    bool self;
  };
  void go_on_from(const Stop& stop) { stop.self ? open(stop.a) : open(stop.a, stop.b); }

  /// All pairs below one node of a single tree.
  void self(Ref ref) {
    if (stops_ != nullptr) return stops_->push_back({ref, ref, true});
    open(ref);
  }
  void open(Ref ref) {
    if (how_.regions != nullptr && how_.regions->nothing_near(ref)) {
      if constexpr (kListed) how_.list->closed.push_back(ref);
      return;
    }
    if (ref < 0) {
      if constexpr (kListed) how_.list->self_leaves.push_back(ref);
      return self_leaf(a_.leaves()[index(~ref)]);
    }
    const Node& node = a_.nodes()[index(ref)];
    for (int i = 0; i < node.count; ++i) {
      self(node.child[i]);
      const std::uint32_t later = first_lanes(node.count) & ~first_lanes(i + 1);
      const std::uint32_t hits = overlap_mask(node.bounds, &node.bounds.row[0][i], kLanes) & later;
      note(node.child[i], ref, later & ~hits, true);
      for_each_bit(hits, [&](int j) { both(node.child[i], node.child[j]); });
    }
  }

  /// All pairs of something below ref_a with something below ref_b, whose bounds are known to overlap. Two nodes are
  /// opened together, unless kLonger asks for the seed's order: one test against all children costs as much as one
  /// against a single child.
  void both(Ref ref_a, Ref ref_b) {
    if (stops_ != nullptr) return stops_->push_back({ref_a, ref_b, false});
    open(ref_a, ref_b);
  }
  void open(Ref ref_a, Ref ref_b) {
    if (ref_a < 0 && ref_b < 0) {
      if constexpr (kListed) how_.list->leaf_pairs.push_back({ref_a, ref_b});
      return leaves(a_.leaves()[index(~ref_a)], b_.leaves()[index(~ref_b)], b_.bound(ref_b));
    }
    if (ref_a < 0 || (kLonger && ref_b >= 0 && b_.bound(ref_b).longest_side() > a_.bound(ref_a).longest_side()))
      return open_b(ref_a, a_.bound(ref_a).row, 1, ref_b);
    const Node& node_a = a_.nodes()[index(ref_a)];
    const std::uint32_t hits_a = overlap_mask(node_a.bounds, b_.bound(ref_b).row, 1) & first_lanes(node_a.count);
    note(ref_b, ref_a, first_lanes(node_a.count) & ~hits_a, false);
    for_each_bit(hits_a, [&](int i) {
      if (kLonger || ref_b < 0)
        both(node_a.child[i], ref_b);
      else
        open_b(node_a.child[i], &node_a.bounds.row[0][i], kLanes, ref_b);
    });
  }

  /// Something below ref_a, whose bound is at `row`, against all children of a node of tree b.
  void open_b(Ref ref_a, const float* row, std::size_t stride, Ref ref_b) {
    const Node& node = b_.nodes()[index(ref_b)];
    const std::uint32_t hits = overlap_mask(node.bounds, row, stride) & first_lanes(node.count);
    note(ref_a, ref_b, first_lanes(node.count) & ~hits, true);
    for_each_bit(hits, [&](int j) { both(ref_a, node.child[j]); });
  }

  void note(Ref query, Ref node, std::uint32_t lanes, bool query_in_a) {
    if constexpr (kListed)
      if (lanes != 0) how_.list->missed.push_back({query, node, static_cast<std::uint16_t>(lanes), query_in_a});
  }

  void self_leaf(const Leaf& leaf) {
    for (int i = 0; i + 1 < leaf.count; ++i) lane(leaf, i, leaf, first_lanes(leaf.count) & ~first_lanes(i + 1));
  }

  void leaves(const Leaf& leaf_a, const Leaf& leaf_b, const MovingKDop<K>& bound_b) {
    const std::uint32_t near_b = overlap_mask(leaf_a.bounds, bound_b.row, 1) & first_lanes(leaf_a.count);
    for_each_bit(near_b, [&](int i) { lane(leaf_a, i, leaf_b, first_lanes(leaf_b.count)); });
  }

  /// Triangle i of leaf a against the `allowed` ones of leaf b.
  void lane(const Leaf& leaf_a, int i, const Leaf& leaf_b, std::uint32_t allowed) {
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
  std::vector<Stop>* stops_ = nullptr;  // where calls are put off to, while they are
};

}  // namespace weft::collision
