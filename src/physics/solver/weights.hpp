// Sparse interpolation weights of the preconditioner.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/linear_system.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// A sparse matrix of weights, with one row per member (particle, or aggregate of the finer level) and one column per
/// aggregate; or its transpose.
template <class Real>
struct Weights {
  std::vector<Index> start;  // rows + 1 entries into columns
  std::vector<Index> columns;
  std::vector<Real> values;

  /// One row of the product of this matrix and the vector `of`.
  PaddedVec3<Real> sum(std::size_t row, std::span<const PaddedVec3<Real>> of) const {
    PaddedVec3<Real> result{};
    for (Index s = start[row]; s < start[row + 1]; ++s) result += values[s] * of[columns[s]];
    return result;
  }
  /// Interpolation from aggregates to their members. If a member has n neighbours, the aggregate of each neighbour gets
  /// the weight `smoothing` / n, and the member's own aggregate 1 − `smoothing`. If several of these aggregates are the
  /// same, their weights add up. Without neighbours, the own aggregate has the weight 1. Replaces `neighbours`, the
  /// neighbours of each member, by the neighbours of each aggregate.
  static Weights make_interpolation(const Aggregates& aggregates, double smoothing,
                                    std::vector<std::vector<Index>>& neighbours);
  /// The transpose, with `rows` rows: the number of columns of this matrix.
  Weights transposed(std::size_t rows) const;
  /// The product of this interpolation and `next`, the interpolation from the next coarser level to
  /// this one.
  Weights times(const Weights& next) const;
};

extern template struct Weights<float>;
extern template struct Weights<double>;

}  // namespace weft::solver
