#include "physics/collision/hierarchy/tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "physics/collision/hierarchy/split.hpp"

namespace weft::collision {

namespace {

/// A set of triangles that results from this many splits at the centre is split further into halves
/// of equal size. A split at the centre may separate only one triangle, so without this limit the
/// depth of the tree could be as large as the number of triangles.
constexpr int kMaxCentreSplits = 64;

void check(const Surface& surface, std::size_t positions, const TreeShape& shape) {
  const Index first = surface.first_vertex, last = first + surface.vertex_count;
  if (first < 0 || static_cast<std::size_t>(last) > positions)
    throw Error(ExitCode::internal, "hierarchy: expected vertices [{}, {}) inside {} positions", first, last,
                positions);
  if (shape.children < 2 || shape.children > kLanes || shape.leaf < 1 || shape.leaf > kLanes)
    throw Error(ExitCode::internal,
                "hierarchy: expected 2 to {0} children and 1 to {0} triangles to a leaf, got {1}, {2}", kLanes,
                shape.children, shape.leaf);
  for (const Triangle& triangle : surface.triangles)
    for (const Index corner : triangle)
      if (corner < first || corner >= last)
        throw Error(ExitCode::internal, "hierarchy: expected corners in [{}, {}), got {}", first, last, corner);
}

// Slack of lazy refits: the motion of kSlackSteps steps at the present speed, plus kMinSlackFraction of the margin for
// vertices that only oscillate. If this sum exceeds kMaxSlackFraction of the margin, the vertex gets no slack, because
// the additional pairs would cost more in the narrow phase than the lazy refit saves.
constexpr double kSlackSteps = 8;
constexpr double kMinSlackFraction = 1.0 / 64;
constexpr double kMaxSlackFraction = 1.0 / 8;

/// Writes one bound into lane l.
template <int K>
void set_lane(LaneBounds<K>& bounds, int l, const MovingKDop<K>& bound) {
  for (int r = 0; r < 2 * K; ++r) bounds.row[r][l] = bound.row[r];
}

}  // namespace

/// Splits a range of triangles recursively into the children of nodes.
template <int K>
struct Tree<K>::Builder {
  struct Group {
    std::size_t begin, end;
    int depth;
    std::size_t size() const { return end - begin; }
  };

  Tree& tree;
  std::size_t max_children, max_triangles;
  std::vector<KDop<K>> bounds;  // of each triangle
  std::vector<Index> order;     // all triangles; those of a group are contiguous

  /// Splits `group` in two: reduces it to the first part and returns the second.
  Group split(Group& group) {
    const std::span<Index> items = std::span(order).subspan(group.begin, group.size());
    const bool deep = ++group.depth > kMaxCentreSplits;
    const std::size_t first = deep ? items.size() / 2 : split_longest_side<K>(items, bounds);
    const Group second{group.begin + first, group.end, group.depth};
    group.end = second.begin;
    return second;
  }

  Ref add_leaf(const Group& group) {
    Leaf leaf{};
    leaf.count = static_cast<std::int32_t>(group.size());
    for (int l = 0; l < kLanes; ++l) {
      const bool used = l < leaf.count;
      const Index local = used ? order[group.begin + static_cast<std::size_t>(l)] : -1;
      leaf.triangle[l] = used ? tree.surface_.first_triangle + local : -1;
      for (std::size_t c = 0; c < 3; ++c) leaf.corners.corner[c][l] = used ? tree.surface_.triangles[local][c] : -1;
    }
    tree.leaves_.push_back(leaf);
    return ~static_cast<Ref>(tree.leaves_.size() - 1);
  }

  Ref add(const Group& whole) {
    if (whole.size() <= max_triangles) return add_leaf(whole);
    // Split the largest child again and again until the node is full, so that few lanes of nodes and leaves remain
    // empty.
    std::array<Group, kLanes> children{whole};
    std::size_t count = 1;
    while (count < max_children) {
      const auto by_size = [](const Group& a, const Group& b) { return a.size() < b.size(); };
      Group& largest =
          *std::max_element(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count), by_size);
      if (largest.size() <= max_triangles) break;
      children[count++] = split(largest);
    }
    const auto number = static_cast<Ref>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    for (std::size_t i = 0; i < count; ++i) {
      const Ref child = add(children[i]);
      tree.nodes_[number].child[i] = child;
    }
    tree.nodes_[number].count = static_cast<std::int32_t>(count);
    return number;
  }
};

template <int K>
Tree<K>::Tree(const Surface& surface, std::span<const Vec3> positions, const TreeShape& shape) : surface_(surface) {
  check(surface, positions.size(), shape);
  vertex_bounds_.resize(static_cast<std::size_t>(surface.vertex_count));
  if (surface.triangles.empty()) return;

  Builder builder{*this, static_cast<std::size_t>(shape.children), static_cast<std::size_t>(shape.leaf), {}, {}};
  builder.bounds.reserve(surface.triangles.size());
  for (const Triangle& triangle : surface.triangles) {
    const auto at = [&](std::size_t c) -> const Vec3& { return positions[triangle[c]]; };
    KDop<K> bound = swept_point<K>(at(0), at(1), 0);
    bound.join(swept_point<K>(at(2), at(2), 0));
    builder.bounds.push_back(bound);
  }
  builder.order.resize(surface.triangles.size());
  std::iota(builder.order.begin(), builder.order.end(), Index{0});
  root_ = builder.add({0, builder.order.size(), 0});

  nodes_.shrink_to_fit();
  leaves_.shrink_to_fit();
  node_bounds_.resize(nodes_.size());
  leaf_bounds_.resize(leaves_.size());
  refit({positions, positions}, 0);
}

template <int K>
void Tree<K>::refit(const Motion& motion, double margin) {
  const auto first = static_cast<std::size_t>(surface_.first_vertex);
  parallel_for(vertex_bounds_.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      vertex_bounds_[v] =
          moving_point<K>(motion.x_t0[first + v], motion.low_t1[first + v], motion.high_t1[first + v], margin);
  });
  parallel_for(leaves_.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) fit_leaf(n);
  });
  // Children have larger numbers than their parent, so they are fitted first.
  for (std::size_t n = nodes_.size(); n-- > 0;) fit_node(n);
  resting_margin_ = -1;
}

/// Fits a leaf to its triangles' corners.
template <int K>
void Tree<K>::fit_leaf(std::size_t n) {
  Leaf& leaf = leaves_[n];
  for (int l = 0; l < leaf.count; ++l) {
    const auto corner = [&](int c) -> const Bound& {
      return vertex_bounds_[leaf.corners.corner[c][l] - surface_.first_vertex];
    };
    Bound bound = corner(0);
    bound.join(corner(1));
    bound.join(corner(2));
    set_lane(leaf.bounds, l, bound);
    if (l == 0)
      leaf_bounds_[n] = bound;
    else
      leaf_bounds_[n].join(bound);
  }
}

/// Fits a node to its children (Etzmuß et al. 2001, Eq. 3).
template <int K>
void Tree<K>::fit_node(std::size_t n) {
  Node& node = nodes_[n];
  node_bounds_[n] = bound(node.child[0]);
  for (int i = 0; i < node.count; ++i) {
    const Bound& child = bound(node.child[i]);
    set_lane(node.bounds, i, child);
    node_bounds_[n].join(child);
  }
}

/// Updates the bound of vertex v, which moves from p to any point of the box from `low` to `high`. Returns false if the
/// old bound is still valid.
template <int K>
bool Tree<K>::update_vertex_bound(std::size_t v, const Vec3& p, const Vec3& low, const Vec3& high, double margin) {
  VertexSlack& vertex_slack = vertex_slacks_[v];
  const double slack_sq = vertex_slack.slack * vertex_slack.slack;
  const bool to_one_place = low == high;
  if (vertex_slack.slack >= 0 && to_one_place && (p - vertex_slack.place).squaredNorm() <= slack_sq &&
      (low - vertex_slack.place).squaredNorm() <= slack_sq)
    return false;
  // The bound with slack covers the ball of radius `slack` around the end position of the vertex. This ball also
  // contains the start position. If `slack` is too large, the bound is that of refit.
  const double slack = kSlackSteps * (low - p).norm() + kMinSlackFraction * margin;
  if (slack <= kMaxSlackFraction * margin && to_one_place) {
    vertex_slack = {low, slack};
    vertex_bounds_[v] = moving_point<K>(low, low, low, margin + slack * (1 + 1e-12));
  } else {
    vertex_slack.slack = -1;
    vertex_bounds_[v] = moving_point<K>(p, low, high, margin);
  }
  return true;
}

template <int K>
void Tree<K>::refit_lazily(const Motion& motion, double margin) {
  const auto first = static_cast<std::size_t>(surface_.first_vertex);
  if (resting_margin_ != margin) vertex_slacks_.assign(vertex_bounds_.size(), {});
  resting_margin_ = margin;
  moved_.resize(vertex_bounds_.size());
  changed_.resize(nodes_.size());
  leaf_changed_.resize(leaves_.size());
  for (std::size_t v = 0; v < vertex_bounds_.size(); ++v)
    moved_[v] = static_cast<std::uint8_t>(
        update_vertex_bound(v, motion.x_t0[first + v], motion.low_t1[first + v], motion.high_t1[first + v], margin));

  for (std::size_t n = 0; n < leaves_.size(); ++n) {
    const Leaf& leaf = leaves_[n];
    std::uint8_t any = 0;
    for (int l = 0; l < leaf.count; ++l)
      for (const auto& row : leaf.corners.corner) any |= moved_[row[l] - surface_.first_vertex];
    leaf_changed_[n] = any;
    if (any != 0) fit_leaf(n);
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    std::uint8_t any = 0;
    for (int i = 0; i < node.count; ++i)
      any |= node.child[i] >= 0 ? changed_[node.child[i]] : leaf_changed_[~node.child[i]];
    changed_[n] = any;
    if (any != 0) fit_node(n);
  }
}

template class Tree<6>;
template class Tree<18>;
template class Tree<26>;

}  // namespace weft::collision
