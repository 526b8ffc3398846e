// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< norms √(rᵀ P⁻¹ r), P the block diagonal
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

  /// The norm √(bᵀ P⁻¹ b) of the constrained part of b: a residual weighed so that soft and stiff particles compare.
  double norm(std::span<const Vec3> b) const;

  /// x (in: anything, out: the solution) until the residual's norm is at most `target`, or after `max_iterations`.
  LinearReport solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x);

  /// Sets the constrained part of each vector entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  double multiply(std::span<const Vec3> p, std::span<Vec3> q) const;
  double precondition(std::span<const Vec3> r, std::span<Vec3> z) const;

  const LinearSystem* system_ = nullptr;
  std::vector<Mat3> inverse_diagonal_;  // already filtered: S P⁻¹ S
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace weft::solver
