// Incomplete Cholesky factorisation with the pattern of the matrix.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// L Lᵀ ≈ S A S + (I − S) in 3×3 blocks, where L has the lower triangle's pattern (Meijerink & van der Vorst, "An
/// Iterative Solution Method for Linear Systems of Which the Coefficient Matrix is a Symmetric M-Matrix", 1977). Along
/// a thread it is nearly exact: the stiffer the threads, the more it has ahead of levels that move groups as a whole.
/// Terms take part with their diagonal blocks.
class IncompleteCholesky {
 public:
  /// False where no factor was found, as of values that are not finite.
  bool factorise(const LinearSystem& system);

  /// z += factor (L Lᵀ)⁻¹ r on the rows of these parts; returns what that adds to r·z. r obeys the constraints, z does
  /// up to rounding.
  double add(double factor, std::span<const Quad<double>> r, std::span<Quad<double>> z, std::span<const Part> parts);

 private:
  void read(const LinearSystem& system);
  bool try_factorise(double shift);

  // Rows of the lower triangle, columns ascending, the diagonal block last.
  std::vector<std::size_t> row_start_;
  std::vector<Index> columns_;
  std::vector<Mat3> factor_;  // as read the matrix, then L with L_ii⁻¹ in place of L_ii
  std::vector<Vec3> y_;
};

}  // namespace weft::solver
