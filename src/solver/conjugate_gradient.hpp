// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/preconditioner.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< norms √(rᵀ P⁻¹ r), P the preconditioner
  bool converged = false;
  bool definite = true;  ///< false: a direction of no or negative curvature came up and the iteration ended there
};

/// Solves A x = b on the free directions.
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
  void filter(std::span<Vec3> b) const { preconditioner_.filter(b); }

 private:
  double multiply(std::span<const Vec3> p, std::span<Vec3> q) const;

  const LinearSystem* system_ = nullptr;
  Preconditioner preconditioner_;
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace weft::solver
