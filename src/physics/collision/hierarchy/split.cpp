#include "physics/collision/hierarchy/split.hpp"

#include <algorithm>
#include <vector>

namespace weft::collision {

namespace {

/// Number of the pair of opposite faces that are furthest apart.
template <int K>
int longest_side(const KDop<K>& hull) {
  int best = 0;
  for (int d = 1; d < K / 2; ++d)
    if (hull.side(d) > hull.side(best)) best = d;
  return best;
}

}  // namespace

template <int K>
std::size_t split_longest_side(std::span<Index> items, std::span<const KDop<K>> bounds) {
  const auto bound = [&](Index item) -> const KDop<K>& { return bounds[item]; };
  KDop<K> hull = bound(items.front());
  for (const Index item : items) hull.join(bound(item));

  const int d = longest_side(hull);
  const float centre = 0.5F * (hull.row[2 * d] - hull.row[2 * d + 1]);
  enum Side { below, above, cut };
  const auto side = [&](Index item) {
    if (-bound(item).row[2 * d + 1] <= centre) return below;
    return bound(item).row[2 * d] >= centre ? above : cut;
  };

  std::array<std::size_t, 3> counts{};
  for (const Index item : items) ++counts[side(item)];
  const Side cut_side = counts[below] <= counts[above] ? below : above;
  const auto goes_first = [&](Index item) {
    const Side s = side(item);
    return (s == cut ? cut_side : s) == below;
  };
  const auto middle = std::stable_partition(items.begin(), items.end(), goes_first);
  const auto first = static_cast<std::size_t>(middle - items.begin());

  return first == 0 || first == items.size() ? items.size() / 2 : first;
}

template std::size_t split_longest_side<6>(std::span<Index>, std::span<const KDop<6>>);
template std::size_t split_longest_side<18>(std::span<Index>, std::span<const KDop<18>>);
template std::size_t split_longest_side<26>(std::span<Index>, std::span<const KDop<26>>);

}  // namespace weft::collision
