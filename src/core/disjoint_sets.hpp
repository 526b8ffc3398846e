// Disjoint sets (union-find).
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/types.hpp"

namespace weft {

/// Partition of the numbers 0 to count − 1 into disjoint sets, initially of one member each. The root of a set is its
/// smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), Index{0}); }

  Index root(Index i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(Index a, Index b) {
    const Index p = root(a), q = root(b);
    parents_[std::max(p, q)] = std::min(p, q);
  }

 private:
  std::vector<Index> parents_;
};

}  // namespace weft
