// One implicit time step (Etzmuß et al. 2001, Fig. 2). The integration method defines an implicit equation, which
// Newton's method solves until the residual is small enough. Constrained conjugate gradients solve its linear systems.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/archive.hpp"
#include "core/timer.hpp"
#include "physics/integrator/method.hpp"
#include "physics/integrator/sliding.hpp"
#include "physics/integrator/system.hpp"
#include "physics/solver/conjugate_gradient.hpp"

namespace weft::integrator {

struct NewtonParameters {
  /// Bound of the remaining velocity error: during the time `Numerics::Newton::error_duration`, this
  /// error displaces a diagonal block by at most this fraction of the local error of the step, or
  /// of a visibility threshold if that is larger. Exceptions: see update_tolerances() in
  /// stepper.cpp.
  double tolerance = 0.3;
  int max_iterations = 60;
  double linear_tolerance = 0.1;  ///< error of a linear solve, relative to its solution, in the energy norm
  int max_linear_iterations = 1000;
  /// If step sizes are adaptive: tolerance of the local error [m], which also bounds the visibility thresholds; else 0.
  double position_tolerance = 0;
};

/// Result of Stepper::step(). Only after `solved` and `unfinished` is the end state valid.
enum class Verdict { solved, unfinished, not_finite, newton_stalled, indefinite };
/// The verdict in words, for messages.
std::string_view describe(Verdict verdict);

struct StageTimes {
  StageTime forces;          ///< evaluation of forces and assembly of their matrix
  StageTime preconditioner;  ///< setup, and applications outside of linear solves
  StageTime linear;          ///< linear solves of Newton's method and, with BDF2, of impacts
};

struct StepReport {
  Verdict verdict = Verdict::solved;
  int newton_iterations = 0;
  int linear_iterations = 0;  ///< of Newton's method and, with BDF2, of impacts
  double local_error = 0;     ///< estimate of the error of positions that the method adds in this step [m]
  /// Estimate of the error of positions that Newton's method adds: the largest remaining velocity
  /// error of a diagonal block times `Numerics::Newton::error_duration` [m]. Includes the error of the
  /// linear solve of impacts if its iterations have run out.
  double solver_error = 0;
  /// Remaining velocity error and its bound, in the diagonal block with the largest ratio
  /// remaining_error / allowed [m/s].
  double remaining_error = 0, allowed = 0;
  StageTimes times;
};

/// Every method is one implicit stage x = x̂ + β v, M (v − v̂) = β f(x, v) with its own β, x̂ and v̂. Below, 0 marks
/// the start of the step, 1 its end, and ₋ the start of the previous step, whose length is h₋; y stands for x and v:
///
///     method     β              x̂, v̂                                         end of the step
///     Euler      h              x0, v0                                       the stage
///     midpoint   h/2            x0, v0                                       2 · stage − start
///     BDF2       h(1+r)/(1+2r)  ((1+r)² y0 − r² y₋)/(1+2r), r = h/h₋         the stage
///
/// Tests compare each method on x'' = −ω² x with the damping and phase that theory gives for it (tests/integrator).
///
/// BDF2 assumes a smooth trajectory. If it integrated impacts like smooth forces, cloth would rebound with up to half
/// of its energy (measured: 48 % for a sheet that falls on a table). Therefore BDF2 steps integrate impacts as Euler's
/// method does, and all other forces in second order, as in nonsmooth generalised-α methods (Chen, Acary, Virlez &
/// Brüls, Int. J. Numer. Meth. Engng 96, 2013). In the solve of a step, impacts displace particles
/// by δ with A δ = F. F are the forces of impacts. A is the matrix of the step with other terms:
/// those of friction in impacts and of contacts that transmit impacts. Positions keep the
/// displacement δ, but velocities change by δ/h instead of δ/β. In the history, the velocity at the
/// start of the step also changes by δ/h, so that the trajectory is smooth for the next step. If
/// the caller changes velocities after the solve, these changes count as impacts, too.
///
/// The local error of positions is estimated from velocities. Let D = (v1 − v0)/h − (v0 − v₋)/h₋ be the change of the
/// mean acceleration from the last step to this one. Then the leading terms of the error are
///
///     Euler      h²/2 x''                           ≈ h/2 (v1 − v0)
///     midpoint   h³/12 x'''                         ≈ h² r / (6 (1+r)) D
///     BDF2       3/2 h³ (1+r)² / (6 r (1+2r)) x'''  ≈ h² (1+r) / (2 (1+2r)) D
///
/// (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 1993, III.2 and III.5). The factor 3/2 of BDF2
/// accounts for the following steps: each adds a third of what the step before it added. Steps
/// without a history use Euler's estimate, which exceeds the error of the midpoint rule in smooth
/// motion. A BDF2 step without a history or beyond longest_step() is an Euler step; its estimate is
/// 3/2 of Euler's. Errors of velocity are not included; they affect positions only in later steps.
/// The error of a diagonal block (a cloth, a rope or a rigid body) is the root mean square over its
/// mass, so that it depends neither on the mesh resolution nor on a single particle in contact. The
/// error of a step is the largest of all blocks. Held directions have no error.
class Stepper {
 public:
  /// Largest ratio of successive BDF2 steps. BDF2 is zero-stable below 1 + √2 (Hairer, Nørsett &
  /// Wanner I, III.5). A step with the ratio r multiplies the change of an error since the last
  /// step by r²/(1+2r): by 1 at that bound, by 4/5 at this ratio.
  static constexpr double kMaxStepRatio = 2;

  Stepper(Method method, const NewtonParameters& parameters) : method_(method), parameters_(parameters) {}

  /// Sets the method of the following steps. Single BDF2 steps may exceed longest_step(): a step that is too long for
  /// the history is an Euler step.
  void set_method(Method method) { method_ = method; }
  Method method() const { return method_; }

  /// Where Newton's method starts: at unchanged velocity, or at the state in `next`, to continue an unfinished step or
  /// to solve a step again with other contacts.
  enum class Start { unchanged_velocity, next };

  /// Computes `next` from `now` over h [s]. Does not change the history: see accept(). `gravity` [m/s²] acts on all
  /// particles. If the step is not solved after `pause_after` Newton iterations of this call, the
  /// verdict is Verdict::unfinished; the caller can inspect `next` and continue with Start::next.
  /// After other failures, `next` is unspecified.
  StepReport step(System& system, const State& now, double h, const Vec3& gravity, std::span<const HeldParticle> held,
                  State& next, Start start = Start::unchanged_velocity,
                  int pause_after = std::numeric_limits<int>::max());

  /// Force [N] with which the constraint acted on a particle of this mass [kg] at the stage of the last computed step.
  /// On a free particle: minus the remaining residual of the equation of motion.
  Vec3 constraint_force(Index particle, double mass) const;

  /// Makes an accepted step over h [s] the history of the next one. `before`, `after`: states at its start and end.
  void accept(const State& before, const State& after, double h);

  struct History {
    State before;  ///< start of the last accepted step; BDF2: v includes impacts (see Stepper)
    double h = 0;  ///< its length [s]; 0: no history
  };
  const History& history() const { return history_; }
  /// Discards a step that is unfinished: the next call of step() does not continue it.
  void discard_unfinished_step() { iterations_before_pause_ = 0; }
  /// Returns to an earlier history, and discards a step that is unfinished.
  void return_to(History history) {
    history_ = std::move(history);
    discard_unfinished_step();
  }

  /// Longest step [s] that may follow the last accepted one; infinite without a history, or if the method has no bound.
  double longest_step() const;

  /// Forgets the history, so that the next BDF2 step is an Euler step. Call it before a discontinuity of the motion.
  void restart() { history_.h = 0; }

  /// Saves or restores the history of `particles` particles and the method, which decides longest_step(). Throws
  /// std::runtime_error if a restored value is impossible.
  template <class Archive>
  void serialize(Archive& archive, std::size_t particles) {
    archive.value(history_.h);
    if constexpr (Archive::kReads) require(history_.h >= 0 && std::isfinite(history_.h), "a step length");
    if (history_.h == 0) return;
    archive.value(method_);
    if constexpr (Archive::kReads)
      require(method_ >= Method::implicit_euler && method_ <= Method::bdf2, "an integration method");
    serialize_points(archive, history_.before.x, particles);
    serialize_points(archive, history_.before.v, particles);
  }

 private:
  struct Stage {
    double beta;      // [s]
    double end_rate;  // dx_end/dx: 1, or 2 for the midpoint rule
  };
  /// State of one diagonal block, usually a cloth.
  struct BlockState {
    solver::DiagonalBlock rows;
    double mass = 0;             // [kg]
    double local_error = 0;      // of the method, at the current iterate [m]
    double velocity_error = 0;   // local error of implicit Euler [m/s]; 0: no history, or a different method
    double allowed = 0;          // bound of the remaining velocity error [m/s]
    double remaining_error = 0;  // remaining velocity error [m/s]
    double rounding = 0;         // lower bound of `allowed`, from rounding of positions [m/s]
    bool holds_sliding = false;  // a constraint holds it against sliding
    double sliding_error = 0;    // of the whole block, from wrong friction [m/s]; 0: none

    double work_error = 0;  // `allowed` before bound_work() reduced it [m/s]; 0: not reduced

    double error() const { return std::max({remaining_error, sliding_error, work_error}); }  // [m/s]
  };

  bool is_first_order(double h) const;
  Stage begin(const State& now, double h);
  StagePoint stage_point() const { return {x_, v_, x_end_, 1 / stage_.beta, stage_.end_rate, past_}; }
  void prepare_guess(const System& system, const State& now, double h, const Vec3& gravity);
  void apply_constraints(const State& now, std::span<const HeldParticle> held,
                         std::vector<solver::ParticleConstraint>& constraints);
  void collect_blocks(std::span<const double> masses, const State& now, const solver::LinearSystem& linear);
  std::span<const Vec3> predict_velocity_change(std::span<const double> masses, const State& now);
  solver::LinearReport solve_linear(std::span<const Vec3> start, std::span<const Vec3> x0);
  double search_along_delta(System& system, const State& now);
  /// Forces that residual() evaluates: System::forces() or System::linear_forces().
  enum class Equation { itself, linear };
  void linearise(System& system, const State& now, int iteration);
  void residual(System& system, const State& now, Equation equation);
  void evaluate(const State& now);
  void gather_residual(std::span<const double> masses);
  void estimate_local_errors(std::span<const double> masses, const State& now, double h);
  void update_tolerances(double h, int iterations);
  static double root_mean_square(const BlockState& block, std::span<const double> masses, std::span<const Vec3> of);
  void balance_momentum(std::span<const double> masses, const solver::LinearSystem& linear);
  std::span<const Vec3> precondition(std::span<const Vec3> residual);
  void compute_rms_speeds(std::span<const Vec3> displacements, std::span<const double> masses,
                          std::vector<double>& speeds) const;
  void estimate_remaining_velocities(const solver::LinearReport& solved, double fraction,
                                     std::span<const double> masses);
  void estimate_sliding_errors(const System& system);
  void select_unsolved(int iterations);
  void bound_work(std::span<const double> masses, const State& now);
  bool is_solved(int iterations) const;
  void report_worst(StepReport& report) const;
  void write_end_state(const State& now, double h, std::span<const HeldParticle> held, State& next) const;
  void split_impacts(System& system, const State& now, double h, StepReport& report);
  Vec3 v_end(const State& now, std::size_t i) const;

  Method method_;
  NewtonParameters parameters_;
  History history_;
  Stage stage_{};                    // of the last step
  int iterations_before_pause_ = 0;  // Newton iterations of the last step(), if it paused; else 0

  // Scratch of one step.
  StageTimes times_;
  solver::ConjugateGradient cg_;
  Sliding sliding_;
  std::vector<BlockState> blocks_;
  std::vector<std::size_t> unsolved_;
  // Per block: allowed linear errors in the mass-weighted norm [√kg m/s], and root mean square velocities [m/s].
  std::vector<double> goals_, predicted_speeds_, solved_speeds_, speeds_;
  std::vector<EarlierPositions> past_;
  std::vector<Vec3> x_hat_, v_hat_, x_, v_, x_end_, constant_force_, force_, residual_, delta_, line_start_, motion_,
      drift_, scratch_;
  // BDF2 only: changes of velocities by impacts, and end velocities as step() returned them [m/s].
  std::vector<Vec3> impact_changes_, solved_v_;
};

}  // namespace weft::integrator
