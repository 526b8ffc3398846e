// The recurrence of conjugate gradients in double or in single precision.
#pragma once

#include <span>
#include <vector>

#include "solver/incomplete_cholesky.hpp"
#include "solver/linear_system.hpp"
#include "solver/part_motions.hpp"
#include "solver/preconditioner.hpp"
#include "solver/product.hpp"
#include "solver/rank_one.hpp"
#include "solver/row_chunks.hpp"

namespace weft::solver {

/// Part of a solution that single precision leaves without telling it from roundings: in the energy norm 6e-8 times the
/// root of the largest stiffness that it is used for, and a factor of five. Tighter goals are worth an incomplete
/// factor.
inline constexpr double kTightGoal = 1e-3;

/// How exact the solution x must be in each part of the system: its error e as measured below is at most the larger of
/// a share of ‖x‖_A, of what the iteration adds to its start, and of an absolute size.
struct LinearGoal {
  double relative = 0;
  std::span<const double> absolute = {};  ///< of each part of the system; empty: none
};

/// What is known of the solution before it is computed; each may be missing.
struct Directions {
  /// Along which the solution is looked for first: x begins with the multiple of it that is best in the energy norm, at
  /// the price of one product.
  std::span<const Vec3> start = {};
  /// Motion to which the solution is added. In the end, forces that are left do no work along the sum, and sum to zero
  /// over each part that no constraint holds: Galerkin's condition for these directions of each part.
  std::span<const Vec3> motion = {};
  /// Another motion along which they do no work either; only beside the first.
  std::span<const Vec3> drift = {};
};

/// What a solve has done so far, in whatever precision.
struct Progress {
  /// What is known of the error of one part.
  struct OfPart {
    double energy = 0;                  ///< ‖x‖²_A
    std::vector<double> gains, shares;  ///< of each iteration: what it took off ‖e‖²_A, the share of the metric in it
    double error_energy() const;        ///< estimate of ‖e‖²_A
    double error_share() const;

   private:
    std::ptrdiff_t recent() const;
  };
  std::vector<OfPart> parts;  ///< of the whole system
  int iterations = 0;
  bool with_factor = false;
  bool nothing_left = false;
  double paced_from = 0;  ///< error at the last look at the pace, in shares of what it may be

  bool meets(const LinearGoal& goal, std::span<const std::size_t> selected) const;
  /// The largest error of these parts, in shares of what it may be: the square of it in the energy norm.
  double farthest_from(const LinearGoal& goal, std::span<const std::size_t> selected) const;
};

enum class End {
  converged,
  out_of_iterations,
  indefinite,    ///< a direction of no or negative curvature came up
  needs_double,  ///< single precision only: what is left is for double, begun anew
};

template <class Real>
class Recurrence {
 public:
  /// Reads the system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system, Sums sums);

  /// P⁻¹ b, valid until the next call.
  std::span<const Quad<Real>> precondition(std::span<const Vec3> b);

  /// Adds to x what solves A x = b on these parts, the others being held.
  End solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
            const Directions& directions, std::span<const std::size_t> parts, Progress& progress);

  /// b − A x of the last solve, on the rows that it was for.
  std::span<const Quad<Real>> residual() const { return r_; }

 private:
  void begin(std::span<const Vec3> b, std::span<const Vec3> x, std::span<const Vec3> start, Progress& progress);
  void begin_along(std::span<const Vec3> start);
  End iterate(const LinearGoal& goal, int max_iterations, Progress& progress);
  double multiply() {
    const double curvature = product_.multiply(p_, q_, moved_);
    return curvature + rank_one_.multiply(p_, q_);
  }
  void apply_levels_and_factor(std::span<const Quad<Real>> r, std::span<Quad<Real>> z, bool with_factor);
  void precondition_rank_one(bool with_factor);
  void advance(double alpha, Progress& progress);
  double apply_preconditioner(std::span<Quad<Real>> z, bool with_factor);
  bool make_factor();
  void balance(const Directions& directions, std::span<Vec3> x);
  std::vector<double> dots(std::span<const Quad<Real>> a, std::span<const Quad<Real>> b) const;
  std::vector<AlongMotions> along_motions(std::span<const Quad<Real>> v, bool has_second) const;

  const LinearSystem* system_ = nullptr;
  std::vector<Part> parts_;
  std::vector<std::size_t> all_parts_, selected_;
  RowChunks rows_;  // of those selected
  Product<Real> product_;
  Preconditioner<Real> preconditioner_;
  RankOneTerms<Real> rank_one_;
  PartMotions part_motions_;
  IncompleteCholesky factor_;                                                   // in double only
  enum class Factor { not_made, made, none } factor_state_ = Factor::not_made;  // of the system as prepared
  std::vector<Part> factor_parts_;                                              // scratch
  std::vector<Quad<Real>> x_, r_, z_, p_, q_;
  std::vector<Vec3> start_;         // as far as constraints let it
  double along_ = 0;                // what the solution has of it, beside x_
  double along_energy_ = 0;         // and what that gains
  std::vector<double> moved_, rz_;  // of each selected part: Σ metric ‖p‖², r·z
};

extern template class Recurrence<float>;
extern template class Recurrence<double>;

}  // namespace weft::solver
