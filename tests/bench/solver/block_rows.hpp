// Sparse rows of blocks of any size, and their products, for solvers with an assembled matrix.
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "physics/solver/linear_system.hpp"

namespace weft::bench {

/// Row i has the entries [start[i], start[i + 1]), columns ascending.
template <class Block>
struct BlockRows {
  Index columns = 0;
  std::vector<std::size_t> start{0};
  std::vector<Index> column;
  std::vector<Block> value;

  Index rows() const { return static_cast<Index>(start.size()) - 1; }
};

/// Assembles both triangles of S (A + terms) S + (I − S). S is the projection on the directions that the constraints
/// leave free.
BlockRows<Mat3> assembled(const solver::LinearSystem& system);

inline double transposed(double weight) {
  return weight;
}
template <int R, int C>
Eigen::Matrix<double, C, R> transposed(const Eigen::Matrix<double, R, C>& block) {
  return block.transpose();
}
template <class Block>
auto transposed(const BlockRows<Block>& a) {
  using Result = decltype(transposed(a.value[0]));
  BlockRows<Result> t;
  t.columns = a.rows();
  t.start.assign(static_cast<std::size_t>(a.columns) + 1, 0);
  for (Index c : a.column) ++t.start[static_cast<std::size_t>(c) + 1];
  for (std::size_t r = 1; r < t.start.size(); ++r) t.start[r] += t.start[r - 1];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<std::size_t> next(t.start.begin(), t.start.end() - 1);
  for (Index i = 0; i < a.rows(); ++i)
    for (std::size_t s = a.start[static_cast<std::size_t>(i)]; s < a.start[static_cast<std::size_t>(i) + 1]; ++s) {
      const std::size_t to = next[static_cast<std::size_t>(a.column[s])]++;
      t.column[to] = i;
      t.value[to] = transposed(a.value[s]);
    }
  return t;
}

template <class A, class B>
auto product(const BlockRows<A>& a, const BlockRows<B>& b) {
  using Result = std::decay_t<decltype((a.value[0] * b.value[0]).eval())>;
  BlockRows<Result> c;
  c.columns = b.columns;
  std::vector<std::size_t> where(static_cast<std::size_t>(b.columns), ~std::size_t{0});
  std::vector<std::pair<Index, Result>> row;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows()); ++i) {
    row.clear();
    for (std::size_t s = a.start[i]; s < a.start[i + 1]; ++s) {
      const auto k = static_cast<std::size_t>(a.column[s]);
      for (std::size_t t = b.start[k]; t < b.start[k + 1]; ++t) {
        const auto j = static_cast<std::size_t>(b.column[t]);
        if (where[j] >= row.size() || row[where[j]].first != b.column[t]) {
          where[j] = row.size();
          row.emplace_back(b.column[t], Result::Zero());
        }
        row[where[j]].second += a.value[s] * b.value[t];
      }
    }
    std::sort(row.begin(), row.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    for (const auto& [j, value] : row) {
      c.column.push_back(j);
      c.value.push_back(value);
    }
    c.start.push_back(c.column.size());
  }
  return c;
}

}  // namespace weft::bench
