#include "solver/block_matrix.hpp"

#include <algorithm>
#include <cassert>

namespace weft::solver {

BlockMatrix::BlockMatrix(Index rows, std::vector<std::pair<Index, Index>> couplings) {
  const std::size_t count = couplings.size();
  couplings.reserve(2 * count + static_cast<std::size_t>(rows));
  for (std::size_t c = 0; c < count; ++c) couplings.emplace_back(couplings[c].second, couplings[c].first);
  for (Index i = 0; i < rows; ++i) couplings.emplace_back(i, i);
  std::sort(couplings.begin(), couplings.end());
  couplings.erase(std::unique(couplings.begin(), couplings.end()), couplings.end());

  row_start_.assign(static_cast<std::size_t>(rows) + 1, 0);
  diagonal_.resize(static_cast<std::size_t>(rows));
  columns_.reserve(couplings.size());
  for (const auto& [i, j] : couplings) {
    assert(i >= 0 && i < rows && j >= 0 && j < rows);
    if (i == j) diagonal_[static_cast<std::size_t>(i)] = static_cast<Slot>(columns_.size());
    columns_.push_back(j);
    row_start_[static_cast<std::size_t>(i) + 1] = static_cast<Index>(columns_.size());
  }
  values_.assign(9 * columns_.size() + 3, 0.0);
}

Slot BlockMatrix::slot(Index row, Index column) const {
  const auto begin = columns_.begin() + row_start_[static_cast<std::size_t>(row)];
  const auto end = columns_.begin() + row_start_[static_cast<std::size_t>(row) + 1];
  const auto found = std::lower_bound(begin, end, column);
  assert(found != end && *found == column);
  return static_cast<Slot>(found - columns_.begin());
}

void BlockMatrix::set_zero() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void BlockMatrix::copy_rows(const BlockMatrix& other, Index begin, Index end) {
  assert(values_.size() == other.values_.size());
  const auto at = [&](Index row) { return 9 * static_cast<std::ptrdiff_t>(row_start_[static_cast<std::size_t>(row)]); };
  std::copy(other.values_.begin() + at(begin), other.values_.begin() + at(end), values_.begin() + at(begin));
}

void BlockMatrix::add_scalar(Slot slot, double value) {
  double* block = values_.data() + 9 * static_cast<std::size_t>(slot);
  block[0] += value;
  block[4] += value;
  block[8] += value;
}

void BlockMatrix::multiply(std::span<const Vec3> x, std::span<Vec3> y, std::size_t begin, std::size_t end) const {
  const double* value = values_.data() + 9 * static_cast<std::size_t>(row_start_[begin]);
  const double* vector = x.data()->data();
  for (std::size_t row = begin; row < end; ++row) {
    // Lane 3 holds the first entry of the next column and is thrown away.
    Lanes sum0{}, sum1{}, sum2{};
    for (Index s = row_start_[row]; s < row_start_[row + 1]; ++s, value += 9) {
      const double* xj = vector + 3 * static_cast<std::size_t>(columns_[static_cast<std::size_t>(s)]);
      sum0 += load(value) * xj[0];
      sum1 += load(value + 3) * xj[1];
      sum2 += load(value + 6) * xj[2];
    }
    const Lanes sum = sum0 + sum1 + sum2;
    y[row] = {sum[0], sum[1], sum[2]};
  }
}

}  // namespace weft::solver
