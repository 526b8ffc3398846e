// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/recurrence.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  std::vector<double> errors = {};  ///< estimate of ‖e‖ in the metric of the system, of each part
  bool converged = false;
  bool definite = true;  ///< false: a direction of no or negative curvature came up and the iteration ended there
};

/// Solves A x = b on the free directions. The preconditioner P is cheap and goes far where a tenth of the residual may
/// stay; where more is asked for, or where it would take long, a factor L is made and P⁻¹ + 16 (L Lᵀ)⁻¹ takes its
/// place.
///
/// Where the metric says that single precision will do, it does, as far as it goes: the residual of the equation that
/// is being solved is computed in double, and what this leaves is in it.
class ConjugateGradient {
 public:
  /// Prepares the preconditioner for this system, which must outlive the calls that follow. Sums::kept: where it has
  /// some since the last time that they were to be made anew.
  void prepare(const LinearSystem& system, Sums sums = Sums::anew);

  /// P⁻¹ b, roughly the solution for b, which obeys the constraints; valid until the next call.
  std::span<const Vec3> precondition(std::span<const Vec3> b);

  /// x: the solution, until its error meets the goal, or after `max_iterations`.
  ///
  /// The error is known from the iteration itself: each step takes α rᵀz off ‖e‖²_A, so what the last steps took was
  /// the square of the error before them, but for what is left (Hestenes & Stiefel 1952; Strakoš & Tichý, "Error
  /// Estimation in Preconditioned Conjugate Gradients", BIT 45, 2005). Parts have shares in it by their shares in rᵀz.
  /// No residual says as much: √(rᵀ P⁻¹ r) is far below ‖e‖_A where the motion is smooth, and so were errors by which
  /// flat sheets folded in free fall. The energy of stiff contacts and threads counts as far as it moves mass: by the
  /// largest share of the metric in the energy of the last steps.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions = {});
  /// As if all particles outside of these parts were held: x is zero there, and residuals there do not count.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions, std::span<const std::size_t> parts);
  /// b − A x of the last solve, on the rows that it was for.
  std::span<const Vec3> residual() const { return residual_; }

  /// Sets the constrained part of each vector entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  const LinearSystem* system_ = nullptr;
  bool is_single_ = false;  // single precision will do for the system as prepared
  /// In one precision, and what it is prepared for.
  template <class Real>
  struct InPrecision {
    Recurrence<Real> recurrence;
    bool has_sums = false;     // since they were to be made anew
    bool is_prepared = false;  // for the system as prepared
  };
  template <class Real>
  Recurrence<Real>& prepared(InPrecision<Real>& in);

  InPrecision<float> single_;
  InPrecision<double> double_;
  std::vector<std::size_t> all_parts_;
  std::vector<Vec3> residual_, preconditioned_;
};

}  // namespace weft::solver
