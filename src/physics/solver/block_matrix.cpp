#include "physics/solver/block_matrix.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <type_traits>
#include <utility>

namespace weft::solver {

namespace {

// Adds (j, i) for each (i, j); sorts, and removes repeats.
void add_transposes(BlockMatrix::Couplings& couplings) {
  const std::size_t count = couplings.size();
  couplings.reserve(2 * count);
  for (std::size_t c = 0; c < count; ++c) couplings.emplace_back(couplings[c].second, couplings[c].first);
  std::sort(couplings.begin(), couplings.end());
  couplings.erase(std::unique(couplings.begin(), couplings.end()), couplings.end());
}

}  // namespace

BlockMatrix::Pattern BlockMatrix::Pattern::of(Index rows, const Couplings& pairs) {
  Pattern pattern;
  pattern.start.assign(static_cast<std::size_t>(rows) + 1, 0);
  pattern.columns.reserve(pairs.size());
  for (const auto& [i, j] : pairs) {
    assert(i >= 0 && i < rows && j >= 0 && j < rows);
    pattern.columns.push_back(j);
    ++pattern.start[static_cast<std::size_t>(i) + 1];
  }
  std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
  return pattern;
}

Index BlockMatrix::Pattern::find(Index row, Index column) const {
  const auto begin = columns.begin() + start[row];
  const auto end = columns.begin() + start[static_cast<std::size_t>(row) + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found != end && *found == column ? static_cast<Index>(found - columns.begin()) : -1;
}

BlockMatrix::BlockMatrix(Index rows, Couplings couplings, Couplings isotropic) {
  for (Index i = 0; i < rows; ++i) couplings.emplace_back(i, i);
  add_transposes(couplings);
  add_transposes(isotropic);
  Couplings others;
  std::ranges::set_difference(isotropic, couplings, std::back_inserter(others));
  Layout layout{Pattern::of(rows, couplings), Pattern::of(rows, others), {}};
  layout.diagonal.reserve(static_cast<std::size_t>(rows));
  for (Index i = 0; i < rows; ++i) layout.diagonal.push_back(layout.full.find(i, i));
  layout_ = std::make_shared<const Layout>(std::move(layout));
  values_.assign(9 * couplings.size() + 3, 0.0);
  scalars_.assign(others.size(), 0.0);
}

Slot BlockMatrix::slot(Index row, Index column) const {
  const Index in_full = full().find(row, column);
  if (in_full >= 0) return in_full;
  const Index in_isotropic = isotropic().find(row, column);
  assert(in_isotropic >= 0);
  return ~in_isotropic;
}

template <class Vector>
void BlockMatrix::multiply(std::span<const Vector> x, std::span<Vector> y, std::size_t begin, std::size_t end) const {
  const auto& [full, isotropic, diagonal] = *layout_;
  const double* value = values_.data() + 9 * static_cast<std::size_t>(full.start[begin]);
  const auto entry = [&](Index column) -> const Vector& { return x[static_cast<std::size_t>(column)]; };
  for (std::size_t row = begin; row < end; ++row) {
    // Lane 3 holds the number after the column, and is ignored.
    Lanes sum0{}, sum1{}, sum2{};
    for (Index s = full.start[row]; s < full.start[row + 1]; ++s, value += 9) {
      const Vector& xj = entry(full.columns[s]);
      sum0 += load_padded(value) * xj[0];
      sum1 += load_padded(value + 3) * xj[1];
      sum2 += load_padded(value + 6) * xj[2];
    }
    const Lanes sum = sum0 + sum1 + sum2;
    double y0 = sum[0], y1 = sum[1], y2 = sum[2];
    for (Index s = isotropic.start[row]; s < isotropic.start[row + 1]; ++s) {
      const Vector& xj = entry(isotropic.columns[s]);
      const double factor = scalars_[s];
      y0 += factor * xj[0];
      y1 += factor * xj[1];
      y2 += factor * xj[2];
    }
    if constexpr (std::is_same_v<Vector, Vec3>)
      y[row] = {y0, y1, y2};
    else
      y[row] = Vector{y0, y1, y2, 0};
  }
}

template void BlockMatrix::multiply(std::span<const Vec3>, std::span<Vec3>, std::size_t, std::size_t) const;
template void BlockMatrix::multiply(std::span<const PaddedVec3<double>>, std::span<PaddedVec3<double>>, std::size_t,
                                    std::size_t) const;

}  // namespace weft::solver
