#include "solver/weights.hpp"

#include <algorithm>
#include <numeric>

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
  return result;
}

template struct Weights<float>;
template struct Weights<double>;

}  // namespace weft::solver
