// Filtered, preconditioned conjugate gradients.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "physics/solver/linear_system.hpp"
#include "physics/solver/recurrence.hpp"

namespace weft::solver {

struct LinearReport {
  int iterations = 0;
  std::vector<double> errors = {};  ///< per diagonal block: estimated error, see solve()
  bool converged = false;
  bool definite = true;  ///< false: the iteration ended at a direction without positive curvature
};

/// Solves A x = b on the directions that the constraints leave free, with the Preconditioner P.
///
/// solve() uses single precision if LinearGoal::relative is at least kSmallestSingleGoal, the system has
/// `norm_weights`, and no particle's relative stiffness exceeds kMaxSingleStiffness (conjugate_gradient.cpp). Single
/// precision is safe because Newton's method evaluates its residual in double, so that the next solve corrects rounding
/// errors. If a direction has no positive curvature in single precision, solve() continues in double.
class ConjugateGradient {
 public:
  /// Sets the system that the following calls solve. The system must not change between these calls: the first one that
  /// needs the preconditioner prepares it. With AggregateSums::reuse, the preconditioner keeps its sums over aggregates
  /// (preconditioner.hpp) if it has computed them since the last call with AggregateSums::recompute; if not, it
  /// computes them. With AggregateSums::recompute, also frees the memory for single or for double precision, if this
  /// precision has not been used for more than kSolvesUnused (conjugate_gradient.cpp) successive calls of this kind.
  void prepare(const LinearSystem& system, AggregateSums sums = AggregateSums::recompute);

  /// Returns P⁻¹ b, a rough solution of A x = b that obeys the constraints. b must obey the
  /// constraints. The result is valid until the next call.
  std::span<const Vec3> precondition(std::span<const Vec3> b);

  /// Starts from zero (ignores the content of x) and takes the step along Directions::start. Then
  /// iterates until the estimated error meets `goal`, or for `max_iterations`.
  ///
  /// The steps of the iteration estimate the error e. A step of length α along a search direction, from the residual r,
  /// reduces ‖e‖²_A by its gain α rᵀz with z = P⁻¹ r. The sum of the last gains estimates ‖e‖²_A as it was before these
  /// steps (Hestenes & Stiefel 1952; Strakoš & Tichý, "Error Estimation in Preconditioned Conjugate Gradients", BIT 45,
  /// 2005). Each diagonal block has its own summand of rᵀz. LinearReport::errors estimates the
  /// error in the mass-weighted norm: the squared error is q times the estimate of ‖e‖²_A. For each of the same last
  /// steps, take the ratio of its squared mass-weighted norm to its gain. q is the largest of these ratios, but at most
  /// 1. If the system has no `norm_weights`, q is 1. The reported error of a diagonal block is 0 if the block is not in
  /// the solve, if there were no iterations, or if the residual is zero up to rounding. √(rᵀz) cannot replace the
  /// estimate: for smooth motion, √(rᵀz) is far below ‖e‖_A, so the iteration would end too early, and flat sheets
  /// would fold in free fall.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions = {});
  /// Solves for these diagonal blocks only: all other particles count as held, so x is zero there.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     const Directions& directions, std::span<const std::size_t> blocks);
  /// b − A x of the last solve, on the rows that it solved for, without constrained components.
  std::span<const Vec3> residual() const { return residual_; }

  /// Sets the constrained components of each entry to zero.
  void filter(std::span<Vec3> b) const;

 private:
  const LinearSystem* system_ = nullptr;
  bool allows_single_ = false;  // for the prepared system
  /// The recurrence in one precision, if it is in use.
  template <class Real>
  struct PrecisionState {
    std::optional<Recurrence<Real>> recurrence;
    bool has_aggregate_sums = false;  // computed since the last AggregateSums::recompute
    bool is_prepared = false;         // for the current system
    int unused = 0;                   // number of prepare() calls with recompute since its last use
    void begin_sums();
  };
  template <class Real>
  Recurrence<Real>& prepare_recurrence(PrecisionState<Real>& in);

  PrecisionState<float> single_;
  PrecisionState<double> double_;
  std::vector<std::size_t> all_blocks_;
  std::vector<Vec3> residual_, preconditioned_;
};

}  // namespace weft::solver
