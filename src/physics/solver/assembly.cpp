#include "physics/solver/assembly.hpp"

#include <algorithm>
#include <cassert>

namespace weft::solver {
namespace {

PackedBlock transposed(const PackedBlock& m) {
  return {__builtin_shufflevector(m.low, m.high, 0, 3, 6, 1), __builtin_shufflevector(m.low, m.high, 4, 7, 2, 5),
          m.last};
}

}  // namespace

Assembly::Assembly(const BlockMatrix& matrix) {
  BlockMatrix::Couplings full, pairs;
  const auto list = [](const BlockMatrix::Pattern& pattern, BlockMatrix::Couplings& into) {
    for (Index row = 0; row + 1 < std::ssize(pattern.start); ++row)
      for (Index s = pattern.start[at(row)]; s < pattern.start[at(row) + 1]; ++s)
        if (pattern.columns[at(s)] > row) into.emplace_back(row, pattern.columns[at(s)]);
  };
  list(matrix.full(), full);
  list(matrix.full(), pairs);
  list(matrix.isotropic(), pairs);
  std::ranges::sort(pairs);
  full_ = BlockMatrix::Pattern::of(matrix.rows(), full);
  pairs_ = BlockMatrix::Pattern::of(matrix.rows(), pairs);
  blocks_.assign(9 * full.size(), 0);
  scalars_.assign(pairs.size(), 0);
  own_.assign(9 * at(matrix.rows()), 0);
  constant_own_.assign(at(matrix.rows()), 0);
  constant_scalars_ = scalars_;
  block_of_.reserve(matrix.full().columns.size());
  scalar_of_full_.reserve(matrix.full().columns.size());
  scalar_of_isotropic_.reserve(matrix.isotropic().columns.size());
  for (Index row = 0; row < matrix.rows(); ++row) {
    for (Index s = matrix.full().start[at(row)]; s < matrix.full().start[at(row) + 1]; ++s) {
      const auto [i, j] = std::minmax(row, matrix.full().columns[at(s)]);
      block_of_.push_back(i == j ? -1 : full_.find(i, j));
      scalar_of_full_.push_back(i == j ? -1 : pairs_.find(i, j));
    }
    for (Index s = matrix.isotropic().start[at(row)]; s < matrix.isotropic().start[at(row) + 1]; ++s)
      scalar_of_isotropic_.push_back(scalar(row, matrix.isotropic().columns[at(s)]));
  }
}

Index Assembly::block(Index i, Index j) const {
  assert(i < j);
  const Index found = full_.find(i, j);
  assert(found >= 0);
  return found;
}

Index Assembly::scalar(Index i, Index j) const {
  const Index found = pairs_.find(std::min(i, j), std::max(i, j));
  assert(found >= 0);
  return found;
}

void Assembly::clear() {
  for (auto* values : {&blocks_, &scalars_, &constant_scalars_, &own_, &constant_own_}) std::ranges::fill(*values, 0);
}

void Assembly::keep_constant() {
  constant_scalars_ = scalars_;
}

void Assembly::start(Index begin, Index end) {
  std::fill(blocks_.begin() + 9 * std::ptrdiff_t{full_.start[at(begin)]},
            blocks_.begin() + 9 * std::ptrdiff_t{full_.start[at(end)]}, 0);
  std::fill(own_.begin() + 9 * std::ptrdiff_t{begin}, own_.begin() + 9 * std::ptrdiff_t{end}, 0);
  const auto from = pairs_.start[at(begin)], to = pairs_.start[at(end)];
  std::copy(constant_scalars_.begin() + from, constant_scalars_.begin() + to, scalars_.begin() + from);
}

void Assembly::write_rows(Index begin, Index end, BlockMatrix& matrix) const {
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  double* const values = matrix.values().data();
  for (Index row = begin; row < end; ++row) {
    PackedBlock sum = packed_scalar(constant_own_[at(row)]);
    const double* own = own_.data() + 9 * at(row);
    sum = sum + PackedBlock{load_lanes(own), load_lanes(own + 4), Lanes{own[8], 0, 0, 0}};
    double scalars = 0;
    for (Index s = isotropic.start[at(row)]; s < isotropic.start[at(row) + 1]; ++s) {
      const double value = scalars_[at(scalar_of_isotropic_[at(s)])];
      matrix.scalars()[at(s)] = value;
      scalars += value;
    }
    double* diagonal = nullptr;
    double* to = values + 9 * at(full.start[at(row)]);
    for (Index s = full.start[at(row)]; s < full.start[at(row) + 1]; ++s, to += 9) {
      const Index from = block_of_[at(s)];
      if (from < 0) {
        diagonal = to;
        continue;
      }
      const double* value = blocks_.data() + 9 * at(from);
      PackedBlock block{load_lanes(value), load_lanes(value + 4), Lanes{value[8], 0, 0, 0}};
      if (diagonal == nullptr) block = transposed(block);  // (row, column) with column < row
      block = block + packed_scalar(scalars_[at(scalar_of_full_[at(s)])]);
      sum = sum + -block;
      store_lanes(to, block.low);
      store_lanes(to + 4, block.high);
      to[8] = block.last[0];
    }
    sum = sum + packed_scalar(-scalars);
    store_lanes(diagonal, sum.low);
    store_lanes(diagonal + 4, sum.high);
    diagonal[8] = sum.last[0];
  }
}

}  // namespace weft::solver
