// Additive multilevel preconditioner: particles, groups of particles, and patches solved together.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"

namespace weft::solver {

/// P⁻¹ = Σ_l R_lᵀ A_l⁻¹ R_l on the free directions: R_l sums over the groups of level l (of a single particle first),
/// A_l is the diagonal of 3×3 blocks of R_l A R_lᵀ, and on the last level all of that matrix. Each level sees motion
/// about as long as its groups are wide (additive Schwarz with piecewise constant coarse spaces; Bramble, Pasciak & Xu,
/// "Parallel Multilevel Preconditioners", 1990). Constraints are applied before preconditioning: blocks are those of
/// S A S + (I − S) (prefiltering, Tamstorf, Jones & McCormick, "Smoothed Aggregation Multigrid for Cloth Simulation",
/// 2015).
class Preconditioner {
 public:
  /// Reads the system, which must outlive the calls that follow. What depends on the matrix and the constraints alone
  /// is kept while they stay the same.
  void prepare(const LinearSystem& system);

  /// z = P⁻¹ r on the rows of these parts, as if r were zero on the others; returns r·z there. r obeys the constraints,
  /// and so does z.
  double apply(std::span<const Vec3> r, std::span<Vec3> z, std::span<const std::size_t> parts);

  /// Sets the constrained part of each entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  /// Groups between single particles and patches.
  struct Level {
    std::vector<Index> group_of;  // per particle
    std::vector<Range> of_part;   // groups of each part
    std::vector<Mat3> of_matrix;  // per group, without terms
    std::vector<Mat3> inverse;    // with them
    std::vector<Vec3> residual, correction;
  };
  void prepare_levels();
  void prepare_particles();
  void sum_blocks(std::size_t part);
  void add_terms();
  void restrict_residual(std::span<const Vec3> r, std::span<const std::size_t> parts);
  void correct_groups(std::span<const std::size_t> parts);
  bool is_free(Index i) const { return constraint_of_[i] < 0; }
  Mat3 filtered(Index i, const Mat3& block, Index j) const;

  const LinearSystem* system_ = nullptr;
  std::vector<Part> parts_;                      // as the sums were made
  std::vector<ParticleConstraint> constraints_;  // likewise
  std::vector<Index> constraint_of_;             // per particle, −1 for none
  std::vector<Mat3> inverse_diagonal_;           // already filtered: S P⁻¹ S
  std::vector<Level> levels_;                    // the last one is that of the patches
  Eigen::MatrixXd patches_of_matrix_, patch_matrix_;
  Eigen::LLT<Eigen::MatrixXd> patch_solver_;
  Eigen::VectorXd patch_vector_;
};

}  // namespace weft::solver
