// Filtered, preconditioned conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "solver/incomplete_cholesky.hpp"
#include "solver/linear_system.hpp"
#include "solver/preconditioner.hpp"

namespace weft::solver {

/// How exact the solution x must be in each part of the system: its error e as measured below is at most the larger of
/// a share of ‖x‖_A, of what the iteration adds to its start, and of an absolute size.
struct LinearGoal {
  double relative = 0;
  std::span<const double> absolute = {};  ///< of each part of the system; empty: none
};

struct LinearReport {
  int iterations = 0;
  std::vector<double> errors = {};  ///< estimate of ‖e‖ in the metric of the system, of each part
  bool converged = false;
  bool definite = true;  ///< false: a direction of no or negative curvature came up and the iteration ended there
};

/// Solves A x = b on the free directions. The preconditioner P is cheap and goes far where a tenth of the residual may
/// stay; where more is asked for, or where it would take long, a factor L is made and P⁻¹ + 16 (L Lᵀ)⁻¹ takes its
/// place.
class ConjugateGradient {
 public:
  /// Prepares the preconditioner for this system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system);

  /// P⁻¹ b, roughly the solution for b, which obeys the constraints; valid until the next call.
  std::span<const Vec3> precondition(std::span<const Vec3> b);

  /// x: the solution, until its error meets the goal, or after `max_iterations`. `start`, if there is one, is a
  /// direction that the solution is looked for along first: x begins with the multiple of it that is best in the energy
  /// norm, at the price of one product.
  ///
  /// The error is known from the iteration itself: each step takes α rᵀz off ‖e‖²_A, so what the last steps took was
  /// the square of the error before them, but for what is left (Hestenes & Stiefel 1952; Strakoš & Tichý, "Error
  /// Estimation in Preconditioned Conjugate Gradients", BIT 45, 2005). Parts have shares in it by their shares in rᵀz.
  /// No residual says as much: √(rᵀ P⁻¹ r) is far below ‖e‖_A where the motion is smooth, and so were errors by which
  /// flat sheets folded in free fall. The energy of stiff contacts and threads counts as far as it moves mass: by the
  /// largest share of the metric in the energy of the last steps.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     std::span<const Vec3> start = {});
  /// As if all particles outside of these parts were held: x is zero there, and residuals there do not count.
  LinearReport solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                     std::span<const Vec3> start, std::span<const std::size_t> parts);
  /// b − A x of the last solve, on the rows that it was for.
  std::span<const Vec3> residual() const { return r_; }

  /// Sets the constrained part of each vector entry to zero.
  void filter(std::span<Vec3> b) const { preconditioner_.filter(b); }

 private:
  void select_terms(std::span<const std::size_t> parts);
  double multiply(std::span<const Vec3> p, std::span<Vec3> q, std::span<const std::size_t> parts) const;
  /// What is known of the error of one part.
  struct PartState {
    double energy = 0;                  // ‖x‖²_A
    std::vector<double> gains, shares;  // of each iteration: what it took off ‖e‖²_A, and the share of the metric in it
    double error_energy() const;        // estimate of ‖e‖²_A
    double error_share() const;
    std::ptrdiff_t recent() const;
  };
  void begin(std::span<const Vec3> b, std::span<const Vec3> start, std::span<Vec3> x,
             std::span<const std::size_t> parts);
  void begin_along(std::span<const Vec3> start, std::span<Vec3> x, std::span<const std::size_t> parts);
  double apply_preconditioner(std::span<Vec3> z, bool with_factor, std::span<const std::size_t> parts);
  void note_gains(double alpha, std::span<const std::size_t> parts);
  bool meets(const LinearGoal& goal, std::span<const std::size_t> parts) const;
  double farthest_from(const LinearGoal& goal, std::span<const std::size_t> parts) const;
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
  std::vector<PartState> states_;
  std::vector<double> part_rz_;  // of each part, r·z
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace weft::solver
