// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/recurrence.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  std::vector<double> errors = {};  ///< estimate of ‖e‖ in the mass-weighted norm, per diagonal block
  bool converged = false;
  bool definite = true;  ///< false: the iteration ended at a direction without positive curvature
};

/// Solves A x = b on the free directions. The preconditioner P of particles and multigrid levels is cheap, and
/// sufficient if a tenth of the residual may stay. For tighter goals, or if the iteration would take long, an
/// incomplete factor L joins it: P⁻¹ + 16 (L Lᵀ)⁻¹.
///
/// Single precision is used as far as the mass-weighted norm allows it. It is safe because Newton's method evaluates
/// its residual in double, which contains whatever a solve in single precision leaves.
class ConjugateGradient {
 public:
  /// Prepares the preconditioner for `system`, which must outlive the following calls. With AggregateSums::reuse, sums
  /// over aggregates are reused if they have been made since the last call with AggregateSums::recompute.
  void prepare(const LinearSystem& system, AggregateSums sums = AggregateSums::recompute);

  /// P⁻¹ b, a rough solution that obeys the constraints. Valid until the next call.
  std::span<const Vec3> precondition(std::span<const Vec3> b);

  /// Iterates x until its error meets `goal`, or for `max_iterations`.
  ///
  /// The iteration itself gives the error: each step reduces ‖e‖²_A by α rᵀz, so the gains of the last steps estimate
  /// the square of the error before them (Hestenes & Stiefel 1952; Strakoš & Tichý, "Error Estimation in Preconditioned
  /// Conjugate Gradients", BIT 45, 2005). Each diagonal block has its own summand of rᵀz. The error in the
  /// mass-weighted norm is that estimate times the largest ratio of mass-weighted norm to energy among the last steps.
  /// √(rᵀ P⁻¹ r) does not replace the estimate: if the motion is smooth it is far below ‖e‖_A, and flat sheets fold in
  /// free fall.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions = {});
  /// Solves for these diagonal blocks only: all other particles count as held, so x and residuals are zero there.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions, std::span<const std::size_t> parts);
  /// b − A x of the last solve, on the rows that it solved for.
  std::span<const Vec3> residual() const { return residual_; }

  /// Sets the constrained components of each entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  const LinearSystem* system_ = nullptr;
  bool allows_single_ = false;  // for the prepared system
  /// Recurrence in one precision, and what it is prepared for.
  template <class Real>
  struct PrecisionState {
    Recurrence<Real> recurrence;
    bool has_aggregate_sums = false;  // made since the last AggregateSums::recompute
    bool is_prepared = false;         // for the current system
  };
  template <class Real>
  Recurrence<Real>& prepare_recurrence(PrecisionState<Real>& in);

  PrecisionState<float> single_;
  PrecisionState<double> double_;
  std::vector<std::size_t> all_parts_;
  std::vector<Vec3> residual_, preconditioned_;
};

}  // namespace weft::solver
