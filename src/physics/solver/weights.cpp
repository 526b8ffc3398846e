#include "physics/solver/weights.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace weft::solver {

template <class Real>
Weights<Real> Weights<Real>::transposed(std::size_t rows) const {
  Weights result;
  result.start.assign(rows + 1, 0);
  for (Index column : columns) ++result.start[column + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.columns.resize(columns.size());
  result.values.resize(values.size());
  std::vector<Index> next = result.start;
  for (std::size_t row = 0; row + 1 < start.size(); ++row)
    for (Index s = start[row]; s < start[row + 1]; ++s) {
      const Index to = next[columns[s]]++;
      result.columns[to] = static_cast<Index>(row);
      result.values[to] = values[s];
    }
  return result;
}

template <class Real>
Weights<Real> Weights<Real>::times(const Weights& next) const {
  Weights result;
  result.start.reserve(start.size());
  result.start.assign(1, 0);
  for (std::size_t row = 0; row + 1 < start.size(); ++row) {
    const auto first = static_cast<std::size_t>(result.start.back());
    for (Index s = start[row]; s < start[row + 1]; ++s)
      for (Index t = next.start[columns[s]]; t < next.start[columns[s] + 1]; ++t) {
        std::size_t at = first;
        while (at < result.columns.size() && result.columns[at] != next.columns[t]) ++at;
        if (at == result.columns.size()) {
          result.columns.push_back(next.columns[t]);
          result.values.push_back(0);
        }
        result.values[at] += values[s] * next.values[t];
      }
    result.start.push_back(static_cast<Index>(result.columns.size()));
  }
  result.columns.shrink_to_fit();
  result.values.shrink_to_fit();
  return result;
}

template <class Real>
Weights<Real> Weights<Real>::make_interpolation(const Aggregates& aggregates, double smoothing,
                                                std::vector<std::vector<Index>>& neighbours) {
  std::vector<std::vector<Index>> next(static_cast<std::size_t>(aggregates.count));
  Weights weights;
  weights.start.reserve(neighbours.size() + 1);
  weights.start.assign(1, 0);
  for (std::size_t m = 0; m < neighbours.size(); ++m) {
    const Index own = aggregates.of[m];
    std::vector<Index> groups;
    for (Index n : neighbours[m]) groups.push_back(aggregates.of[n]);
    const double neighbour_weight = groups.empty() ? 0 : smoothing / static_cast<double>(groups.size());
    groups.push_back(own);
    std::ranges::sort(groups);
    for (auto first = groups.begin(); first != groups.end();) {
      const auto last = std::upper_bound(first, groups.end(), *first);
      const auto count = static_cast<double>(last - first);
      const double weight = *first != own        ? neighbour_weight * count
                            : groups.size() == 1 ? 1
                                                 : 1 - smoothing + neighbour_weight * (count - 1);
      if (weight > 0) {
        weights.columns.push_back(*first);
        weights.values.push_back(static_cast<Real>(weight));
      }
      if (*first != own) next[own].push_back(*first);
      first = last;
    }
    weights.start.push_back(static_cast<Index>(weights.columns.size()));
  }
  for (std::vector<Index>& of_group : next) {
    std::ranges::sort(of_group);
    of_group.erase(std::unique(of_group.begin(), of_group.end()), of_group.end());
  }
  neighbours = std::move(next);
  weights.columns.shrink_to_fit();
  weights.values.shrink_to_fit();
  return weights;
}

template struct Weights<float>;
template struct Weights<double>;

}  // namespace weft::solver
