// A few directions of each part of a system: its translations, and motions that are given.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// Motions at most.
inline constexpr int kMotions = 2;
/// Directions of one part: its translations, and the motions.
inline constexpr int kDirections = 3 + kMotions;
/// Coordinates of one part along these, or forces along them.
using AlongMotions = Eigen::Matrix<double, kDirections, 1>;

/// The system on the space of these directions. A part has translations if no constraint holds any of its particles. A
/// motion that is a combination of those before it, but for roundings, does not count twice.
class PartMotions {
 public:
  /// Of each motion, what the product of the whole system with it is along the directions of one part.
  using Products = Eigen::Matrix<double, kDirections, kMotions>;

  /// Reads the system. `motions`: of each row, as constraints let it, and zero outside of the selected parts; empty if
  /// there is none. `row_sums`: of each selected part, the sum of all blocks of the matrix.
  template <class Real>
  void prepare(const LinearSystem& system, std::span<const std::size_t> selected,
               const std::array<std::span<const Quad<Real>>, kMotions>& motions, std::span<const Mat3> row_sums,
               std::span<const Products> products);

  /// The coordinates at which these forces are balanced; both of each selected part.
  std::vector<AlongMotions> solve(std::span<const AlongMotions> forces) const;

 private:
  void find_used(std::size_t part, const Eigen::Matrix<double, kDirections, kDirections>& block);

  std::vector<std::array<bool, kDirections>> is_used_;  // of each selected part
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace weft::solver
