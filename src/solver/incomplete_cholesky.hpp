// Incomplete Cholesky factorisation with the pattern of the matrix.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/padded_vec3.hpp"

namespace weft::solver {

/// L Lᵀ ≈ S A S + (I − S) in 3×3 blocks, where S projects on the free directions and L has the pattern of the lower
/// triangle (Meijerink & van der Vorst, "An Iterative Solution Method for Linear Systems of Which the Coefficient
/// Matrix is a Symmetric M-Matrix", 1977). L Lᵀ is nearly exact along a thread: the stiffer the threads, the more
/// iterations it saves. Terms enter with their 3×3 diagonal blocks; outer products do not.
class IncompleteCholesky {
 public:
  /// Returns false if no factor exists even with the largest shift, for example because values are not finite.
  bool factorise(const LinearSystem& system);

  /// z += factor (L Lᵀ)⁻¹ r on the rows of `parts`; returns the increase of r·z. If r obeys the constraints, as it
  /// must, z still does, up to rounding.
  double add(double factor, std::span<const PaddedVec3<double>> r, std::span<PaddedVec3<double>> z,
             std::span<const DiagonalBlock> parts);

 private:
  void read(const LinearSystem& system);
  bool try_factorise(double shift);

  // Rows of the lower triangle, columns ascending, the diagonal block last.
  std::vector<std::size_t> row_start_;
  std::vector<Index> columns_;
  std::vector<Mat3> factor_;  // the matrix, then L with L_ii⁻¹ in place of L_ii
  std::vector<Vec3> y_;
};

}  // namespace weft::solver
