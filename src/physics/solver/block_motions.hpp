// Galerkin correction along a few directions per diagonal block: three translations of all its particles together, and
// up to two motions that the caller gives.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <span>
#include <vector>

#include "physics/solver/linear_system.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// Maximum number of motions that the caller gives.
inline constexpr int kMaxMotions = 2;
/// Directions of one diagonal block: three translations, then the motions.
inline constexpr int kDirections = 3 + kMaxMotions;
/// One number per direction of a diagonal block: its coefficient in a displacement, or the work of
/// forces along it.
using AlongMotions = Eigen::Matrix<double, kDirections, 1>;

/// The linear system, projected on the directions of the selected diagonal blocks. Uses the
/// translations of a diagonal block only if no constraint acts on its particles. Skips a motion
/// that is nearly a combination of the directions before it (kMinIndependentEnergy in
/// block_motions.cpp).
class BlockMotions {
 public:
  /// Column m: the system (matrix and terms) times motion m, projected on the directions of one diagonal block.
  using Products = Eigen::Matrix<double, kDirections, kMaxMotions>;

  /// Builds and factorises the projected system. `motions`: each has one entry per row, filtered by the constraints,
  /// and zero outside of the selected diagonal blocks; an empty one is absent. `row_sums`: per selected diagonal block,
  /// the sum of all its 3×3 blocks without terms, which is the matrix projected on the translations. `products`: one
  /// per selected diagonal block.
  template <class Real>
  void prepare(const LinearSystem& system, std::span<const std::size_t> selected,
               const std::array<std::span<const PaddedVec3<Real>>, kMaxMotions>& motions,
               std::span<const Mat3> row_sums, std::span<const Products> products);

  /// Returns the coefficients of the displacement that balances forces with the work `forces` along
  /// the directions. The argument and the result have one entry per selected diagonal block.
  std::vector<AlongMotions> solve(std::span<const AlongMotions> forces) const;

 private:
  void find_used(std::size_t block_index, const Eigen::Matrix<double, kDirections, kDirections>& block);

  std::vector<std::array<bool, kDirections>> is_used_;  // per selected block
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace weft::solver
