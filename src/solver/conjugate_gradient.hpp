// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/incomplete_cholesky.hpp"
#include "solver/linear_system.hpp"
#include "solver/preconditioner.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< norms √(rᵀ P⁻¹ r), P the preconditioner
  bool converged = false;
  bool definite = true;  ///< false: a direction of no or negative curvature came up and the iteration ended there
};

/// Solves A x = b on the free directions. The preconditioner P is cheap and goes far where a tenth of the residual may
/// stay; where more is asked for, or where it would take long, a factor L is made and P⁻¹ + 16 (L Lᵀ)⁻¹ takes its
/// place. Norms remain those of P.
class ConjugateGradient {
 public:
  /// Prepares the preconditioner for this system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system);

  /// The norm √(bᵀ P⁻¹ b) of the constrained part of b, close to the energy norm of the error it stands for: a residual
  /// weighed so that soft and stiff motions compare.
  double norm(std::span<const Vec3> b);
  /// What each part of the system adds to the square of the norm of b, which obeys the constraints.
  std::span<const double> part_norms_sq(std::span<const Vec3> b);

  /// x (in: anything, out: the solution) until the residual's norm is at most `target`, or after `max_iterations`.
  LinearReport solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x);
  /// As if all particles outside of these parts were held: x is zero there, and residuals there do not count.
  LinearReport solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x,
                     std::span<const std::size_t> parts);

  /// Sets the constrained part of each vector entry to zero.
  void filter(std::span<Vec3> b) const { preconditioner_.filter(b); }

 private:
  void select_terms(std::span<const std::size_t> parts);
  double multiply(std::span<const Vec3> p, std::span<Vec3> q, std::span<const std::size_t> parts) const;
  bool make_factor();
  double add_factor(std::span<Vec3> z, std::span<const std::size_t> parts);

  const LinearSystem* system_ = nullptr;
  Preconditioner preconditioner_;
  IncompleteCholesky factor_;
  enum class Factor { not_made, made, none } factor_state_ = Factor::not_made;  // of the system as prepared
  std::vector<Part> factor_parts_;                                              // scratch
  std::vector<Part> parts_;
  std::vector<std::size_t> all_parts_;
  std::vector<const StencilTerm*> terms_;  // that act on the parts being solved for
  std::vector<double> part_norms_sq_;
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace weft::solver
