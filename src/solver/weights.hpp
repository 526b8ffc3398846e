// Sparse weights by which the preconditioner interpolates.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// Rows of weights: of a member of groups in each of them, or the other way round.
template <class Real>
struct Weights {
  std::vector<Index> start;  // rows + 1 entries into columns
  std::vector<Index> columns;
  std::vector<Real> values;

  Quad<Real> sum(std::size_t row, std::span<const Quad<Real>> of) const {
    Quad<Real> result{};
    for (Index s = start[row]; s < start[row + 1]; ++s) result += values[s] * of[columns[s]];
    return result;
  }
  /// From groups to their members. A member follows its own group, and by a share `smoothing` those of its neighbours.
  /// `neighbours`: of each member; becomes those of the groups.
  static Weights interpolating(const Grouping& grouping, double smoothing, std::vector<std::vector<Index>>& neighbours);
  /// With `rows` rows.
  Weights transposed(std::size_t rows) const;
  /// Of members in the groups of `next`, where these are of members in groups that are the members of `next`.
  Weights times(const Weights& next) const;
};

extern template struct Weights<float>;
extern template struct Weights<double>;

}  // namespace weft::solver
