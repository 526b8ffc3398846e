#include "physics/collision/hierarchy/query.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace weft::collision {
namespace {

/// Minimum of row r of bound l over start and end of the motion. Rows 0 to 5 are the directions ±x, ±y, ±z.
template <int K>
float row_over_motion(const LaneBounds<K>& bounds, int r, int l) {
  return std::min(bounds.row[r][l], bounds.row[K + r][l]);
}

/// Squared distances of a point from the boxes of eight bounds [m²].
template <int K>
std::array<double, kLanes> box_distances_sq(const LaneBounds<K>& bounds, const Vec3& p) {
  std::array<double, kLanes> all{};
  for (int axis = 0; axis < 3; ++axis)
    for (int l = 0; l < kLanes; ++l) {
      const double below = row_over_motion(bounds, 2 * axis, l) - p[axis],
                   above = row_over_motion(bounds, 2 * axis + 1, l) + p[axis];
      const double gap = std::max({below, above, 0.0});
      all[l] += gap * gap;
    }
  return all;
}

template <int K>
class NearestQuery {
 public:
  using Ref = typename Tree<K>::Ref;

  NearestQuery(const Tree<K>& tree, const Vec3& p, const DistanceSq& distance_sq)
      : tree_(tree), p_(p), distance_sq_(distance_sq) {}

  void visit(Ref ref) {
    if (ref < 0) return visit_leaf(tree_.leaves()[~ref]);
    const auto& node = tree_.nodes()[ref];
    const auto lower_bound_sq = box_distances_sq(node.bounds, p_);
    // Visit the nearest child first, because its triangles may exclude the others.
    std::array<int, kLanes> order{0, 1, 2, 3, 4, 5, 6, 7};
    std::sort(order.begin(), order.begin() + node.count,
              [&](int i, int j) { return lower_bound_sq[i] < lower_bound_sq[j]; });
    for (int i = 0; i < node.count; ++i)
      if (is_candidate(lower_bound_sq[order[i]])) visit(node.child[order[i]]);
  }

  void finish(std::vector<Index>& out) const {
    out.clear();
    for (const Found& found : found_)
      if (is_candidate(found.distance_sq)) out.push_back(found.triangle);
    std::sort(out.begin(), out.end());
  }

 private:
  struct Found {
    Index triangle;
    double distance_sq;
  };

  bool is_candidate(double distance_sq) const {
    return distance_sq < kNone && distance_sq <= (1 + kNearestTolerance) * best_sq_;
  }

  void visit_leaf(const typename Tree<K>::Leaf& leaf) {
    const auto lower_bound_sq = box_distances_sq(leaf.bounds, p_);
    for (int l = 0; l < leaf.count; ++l) {
      if (!is_candidate(lower_bound_sq[l])) continue;
      const double distance_sq = distance_sq_(leaf.triangle[l]);
      if (!is_candidate(distance_sq)) continue;
      found_.push_back({leaf.triangle[l], distance_sq});
      best_sq_ = std::min(best_sq_, distance_sq);
    }
  }

  static constexpr double kNone = std::numeric_limits<double>::infinity();

  const Tree<K>& tree_;
  const Vec3& p_;
  const DistanceSq& distance_sq_;
  double best_sq_ = kNone;
  std::vector<Found> found_;
};

/// Bit l is set if the box of bound l overlaps the box from `low` to `high`.
template <int K>
std::uint32_t overlapping_boxes(const LaneBounds<K>& bounds, const Vec3& low, const Vec3& high) {
  std::uint32_t mask = 0;
  for (int l = 0; l < kLanes; ++l) {
    bool meets = true;
    for (int axis = 0; axis < 3; ++axis)
      meets &=
          row_over_motion(bounds, 2 * axis, l) <= high[axis] && -row_over_motion(bounds, 2 * axis + 1, l) >= low[axis];
    mask |= static_cast<std::uint32_t>(meets) << l;
  }
  return mask;
}

template <int K>
void append_below(const Tree<K>& tree, typename Tree<K>::Ref ref, const Vec3& low, const Vec3& high,
                  std::vector<Index>& out) {
  if (ref < 0) {
    const auto& leaf = tree.leaves()[~ref];
    for_each_bit(overlapping_boxes(leaf.bounds, low, high) & first_lanes(leaf.count),
                 [&](int l) { out.push_back(leaf.triangle[l]); });
    return;
  }
  const auto& node = tree.nodes()[ref];
  for_each_bit(overlapping_boxes(node.bounds, low, high) & first_lanes(node.count),
               [&](int i) { append_below(tree, node.child[i], low, high, out); });
}

}  // namespace

template <int K>
void nearest_triangles(const Tree<K>& tree, const Vec3& p, const DistanceSq& distance_sq, std::vector<Index>& out) {
  NearestQuery<K> query(tree, p, distance_sq);
  if (!tree.empty()) query.visit(tree.root());
  query.finish(out);
}

template <int K>
void triangles_in_box(const Tree<K>& tree, const Vec3& low, const Vec3& high, std::vector<Index>& out) {
  out.clear();
  if (!tree.empty()) append_below(tree, tree.root(), low, high, out);
  std::sort(out.begin(), out.end());
}

#define WEFT_INSTANTIATE(K)                                                                             \
  template void nearest_triangles(const Tree<K>&, const Vec3&, const DistanceSq&, std::vector<Index>&); \
  template void triangles_in_box(const Tree<K>&, const Vec3&, const Vec3&, std::vector<Index>&);
WEFT_INSTANTIATE(6)
WEFT_INSTANTIATE(18)
WEFT_INSTANTIATE(26)
#undef WEFT_INSTANTIATE

}  // namespace weft::collision
