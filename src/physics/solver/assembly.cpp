#include "physics/solver/assembly.hpp"

#include <algorithm>
#include <cassert>

namespace weft::solver {
namespace {

PackedBlock transposed(const PackedBlock& m) {
  return {__builtin_shufflevector(m.low, m.high, 0, 3, 6, 1), __builtin_shufflevector(m.low, m.high, 4, 7, 2, 5),
          m.last};
}

PackedBlock load_block(const double* values) {
  return {load_padded(values), load_padded(values + 4), Lanes{values[8], 0, 0, 0}};
}

void store_block(double* values, const PackedBlock& block) {
  store_padded(values, block.low);
  store_padded(values + 4, block.high);
  values[8] = block.last[0];
}

}  // namespace

Assembly::Assembly(const BlockMatrix& matrix) : layout_(matrix.layout()) {
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  BlockMatrix::Couplings pairs;
  for (const BlockMatrix::Pattern* pattern : {&full, &isotropic})
    for (Index row = 0; row < matrix.rows(); ++row)
      for (Index s = pattern->start[at(row)]; s < pattern->start[at(row) + 1]; ++s)
        if (pattern->columns[at(s)] > row) pairs.emplace_back(row, pattern->columns[at(s)]);
  std::ranges::sort(pairs);
  pairs_ = BlockMatrix::Pattern::of(matrix.rows(), pairs);
  scalars_.assign(pairs.size(), 0);
  constant_scalars_ = scalars_;
  constant_own_.assign(at(matrix.rows()), 0);
  const std::size_t full_pairs = (full.columns.size() - at(matrix.rows())) / 2;
  scalar_of_pair_.reserve(full_pairs);
  pair_of_.reserve(full_pairs);
  first_of_row_.reserve(at(matrix.rows()));
  scalar_of_isotropic_.reserve(isotropic.columns.size());
  for (Index row = 0; row < matrix.rows(); ++row) {
    first_of_row_.push_back(static_cast<Index>(pair_of_.size()));
    for (Index s = full.start[at(row)]; s < matrix.diagonal(row); ++s)
      pair_of_.push_back(block(full.columns[at(s)], row));
    for (Index s = matrix.diagonal(row) + 1; s < full.start[at(row) + 1]; ++s)
      scalar_of_pair_.push_back(scalar(row, full.columns[at(s)]));
    for (Index s = isotropic.start[at(row)]; s < isotropic.start[at(row) + 1]; ++s)
      scalar_of_isotropic_.push_back(scalar(row, isotropic.columns[at(s)]));
  }
}

Index Assembly::block(Index i, Index j) const {
  assert(i < j);
  const Index found = layout_->full.find(i, j);
  assert(found >= 0);
  return found;
}

Index Assembly::scalar(Index i, Index j) const {
  const Index found = pairs_.find(std::min(i, j), std::max(i, j));
  assert(found >= 0);
  return found;
}

void Assembly::clear() {
  for (auto* values : {&scalars_, &constant_scalars_, &constant_own_}) std::ranges::fill(*values, 0);
}

void Assembly::keep_constant() {
  constant_scalars_ = scalars_;
}

void Assembly::start(Index begin, Index end, BlockMatrix& matrix) {
  double* const values = matrix.values().data();
  for (Index row = begin; row < end; ++row)
    std::fill(values + 9 * at(matrix.diagonal(row)), values + 9 * at(matrix.full().start[at(row) + 1]), 0.0);
  const auto from = pairs_.start[at(begin)], to = pairs_.start[at(end)];
  std::copy(constant_scalars_.begin() + from, constant_scalars_.begin() + to, scalars_.begin() + from);
}

void Assembly::complete_pairs(Index begin, Index end, BlockMatrix& matrix) const {
  const BlockMatrix::Pattern& full = matrix.full();
  for (Index row = begin; row < end; ++row) {
    const Index* scalar = scalar_of_pair_.data() + (full.start[at(row)] - row - first_of_row_[at(row)]);
    double* value = matrix.values().data() + 9 * at(matrix.diagonal(row));
    for (Index s = matrix.diagonal(row) + 1; s < full.start[at(row) + 1]; ++s) {
      value += 9;
      store_block(value, load_block(value) + packed_scalar(scalars_[at(*scalar++)]));
    }
  }
}

void Assembly::complete_rows(Index begin, Index end, BlockMatrix& matrix) const {
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  double* const values = matrix.values().data();
  for (Index row = begin; row < end; ++row) {
    const Index diagonal = matrix.diagonal(row);
    PackedBlock sum = packed_scalar(constant_own_[at(row)]) + load_block(values + 9 * at(diagonal));
    double scalars = 0;
    for (Index s = isotropic.start[at(row)]; s < isotropic.start[at(row) + 1]; ++s) {
      const double value = scalars_[at(scalar_of_isotropic_[at(s)])];
      matrix.scalars()[at(s)] = value;
      scalars += value;
    }
    const Index* pair = pair_of_.data() + first_of_row_[at(row)];
    double* to = values + 9 * at(full.start[at(row)]);
    for (Index s = full.start[at(row)]; s < diagonal; ++s, to += 9) {
      const PackedBlock block = transposed(load_block(values + 9 * at(*pair++)));
      sum = sum + -block;
      store_block(to, block);
    }
    for (Index s = diagonal + 1; s < full.start[at(row) + 1]; ++s) sum = sum + -load_block(values + 9 * at(s));
    store_block(to, sum + packed_scalar(-scalars));
  }
}

}  // namespace weft::solver
