// Filtered, preconditioned conjugate gradients.
#pragma once

#include <Eigen/Cholesky>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< norms √(rᵀ P⁻¹ r), P the preconditioner
  bool converged = false;
  bool definite = true;  ///< false: a direction of no or negative curvature came up and the iteration ended there
};

/// Solves A x = b on the free directions. Constraints are applied before preconditioning: the block-Jacobi blocks are
/// those of S A S + (I − S), so preconditioned directions obey them (prefiltering, Tamstorf, Jones & McCormick,
/// "Smoothed Aggregation Multigrid for Cloth Simulation", 2015).
class ConjugateGradient {
 public:
  /// Prepares the preconditioner for this system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system);

  /// The norm √(bᵀ P⁻¹ b) of the constrained part of b, close to the energy norm of the error it stands for: a residual
  /// weighed so that soft and stiff motions compare.
  double norm(std::span<const Vec3> b);

  /// x (in: anything, out: the solution) until the residual's norm is at most `target`, or after `max_iterations`.
  LinearReport solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x);

  /// Sets the constrained part of each vector entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  double multiply(std::span<const Vec3> p, std::span<Vec3> q) const;
  double precondition(std::span<const Vec3> r, std::span<Vec3> z);
  void prepare_patches();

  const LinearSystem* system_ = nullptr;
  std::vector<Mat3> inverse_diagonal_;  // already filtered: S P⁻¹ S
  std::vector<Index> constraint_of_;    // per particle, −1 for none
  Eigen::MatrixXd patch_matrix_;
  Eigen::LLT<Eigen::MatrixXd> patch_solver_;
  Eigen::VectorXd patch_residual_, patch_correction_;
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace weft::solver
