// One implicit time step (seed, Fig. 2): method → implicit equation → Newton with residual control → constrained CG.
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
#include "integrator/sliding.hpp"
#include "integrator/system.hpp"
#include "solver/conjugate_gradient.hpp"

namespace weft::integrator {

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

struct NewtonParameters {
  /// What Newton's method and the linear solver leave of a step may be this share of the step's own local error, or of
  /// what nobody sees where that is more; see allow_velocities() in stepper.cpp.
  double tolerance = 0.3;
  int max_iterations = 60;
  double linear_tolerance = 0.1;  ///< of one linear solve, relative to its own solution, in the energy norm
  int max_linear_iterations = 1000;
  /// Where the local error of a step is held below a tolerance, that tolerance [m]; 0: nowhere. Nothing above it then
  /// counts as unseen.
  double position_tolerance = 0;
};

enum class Verdict { solved, unfinished, not_finite, newton_stalled, indefinite };
std::string_view describe(Verdict verdict);

struct StageTimes {
  StageTime forces;          ///< evaluated, and their matrix put together
  StageTime preconditioner;  ///< set up, and applied to residuals
  StageTime linear;          ///< iterations of the linear solver
};

struct StepReport {
  Verdict verdict = Verdict::solved;
  int newton_iterations = 0;
  int linear_iterations = 0;
  double local_error = 0;  ///< estimate of what the method adds to the error of positions in this step [m]
  /// And of what the solver adds: the velocity that it left, times `Numerics::Newton::lasting_time` [m].
  double solver_error = 0;
  double left = 0, allowed = 0;  ///< velocity that the solver left in the worst part, and might have [m/s]
  StageTimes times;
};

/// Every method is one implicit stage  x = x̂ + β v,  M (v − v̂) = β f(x, v)  with its own β, x̂ and v̂:
///
///     method     β              x̂, v̂                                         end of the step
///     Euler      h              x0, v0                                       the stage
///     midpoint   h/2            x0, v0                                       2 · stage − start
///     BDF2       h(1+r)/(1+2r)  ((1+r)² y0 − r² y₋)/(1+2r), r = h/h₋         the stage
///
/// Checked on x'' = −ω² x against the exact damping and phase of each (tests/integrator).
///
/// BDF2 expects a smooth trajectory. Left alone it throws back what strikes an obstacle, with up to half of its
/// velocity: a sheet that falls on a table kept 48 % of its energy. So it takes impacts as Euler's method does, and all
/// else in second order, as nonsmooth generalised-α methods do (Chen, Acary, Virlez & Brüls, Int. J. Numer. Meth. Engng
/// 96, 2013). Impacts move particles by δ, A δ = F, with the forces F of impacts and the matrix A of the step without
/// contacts and ties. Positions stay as they are; velocities change by δ/h in place of δ/β, and so does the history, in
/// which the next step then finds a smooth trajectory. What corrections change of velocities after a solve are impacts,
/// too.
///
/// The local error of positions follows from velocities that are there anyway. With D the change of the mean
/// acceleration from the last step to this one, (v1 − v0)/h − (v0 − v₋)/h₋, its leading terms are
///
///     Euler      h²/2 x''                           ≈ h/2 (v1 − v0)
///     midpoint   h³/12 x'''                         ≈ h² r / (6 (1+r)) D
///     BDF2       3/2 h³ (1+r)² / (6 r (1+2r)) x'''  ≈ h² (1+r) / (2 (1+2r)) D
///
/// (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 1993, III.2 and III.5). The 3/2 of BDF2 is for
/// the steps that follow, which take a third of each change of the error on. Steps without a history are estimated as
/// Euler's: right for BDF2, which then is Euler; an upper bound for midpoint. Errors of velocity show in positions only
/// later, through the steps that follow, and are not in it. It is measured per part of the system (a cloth): the root
/// of the mean square over its mass, which refinement of the mesh leaves as it is, and that a single particle in a
/// contact does not decide; the largest part counts. Held directions have none.
class Stepper {
 public:
  /// Largest growth from one step to the next of BDF2. It is zero-stable below 1 + √2 (Hairer, Nørsett & Wanner I,
  /// III.5): there a change of the error is taken on in full by each next step, with this ratio by four fifths.
  static constexpr double kLargestRatio = 2;

  Stepper(Method method, const NewtonParameters& parameters) : method_(method), parameters_(parameters) {}

  /// For the steps from here on. Who takes BDF2 for single steps does not keep to longest_step(): where one is too long
  /// to follow the last one it is Euler's.
  void use(Method method) { method_ = method; }

  /// Where the search for the end of a step starts: at unchanged velocity, or at what `next` holds, for a step that is
  /// solved once more with other contacts.
  enum class Start { unchanged_velocity, next };

  /// Computes `next` from `now` over h [s]. Nothing is remembered: see accept().
  /// `gravity` [m/s²] acts on all particles. Who wants to look at what comes of it, and go on from there, has it end
  /// unfinished after `look_after` iterations of Newton's method.
  StepReport step(System& system, const State& now, double h, const Vec3& gravity, std::span<const HeldParticle> held,
                  State& next, Start start = Start::unchanged_velocity,
                  int look_after = std::numeric_limits<int>::max());

  /// Force [N] with which its constraint acted on a particle of this mass [kg] at the end of the last step computed.
  Vec3 constraint_force(Index particle, double mass) const;

  /// Makes `before`, the state at the start of the step over h just accepted, the history of the next step; `after` is
  /// the state at its end.
  void accept(const State& before, const State& after, double h);

  /// What the next step knows of those before: all that lasts from step to step.
  struct History {
    State before;  ///< the last step accepted began there
    double h = 0;  ///< and was so long [s]; 0: there is none
  };
  const History& history() const { return history_; }
  void return_to(History history) { history_ = std::move(history); }

  /// Longest step that may follow the last one accepted [s]; infinite where the method has no bound.
  double longest_step() const;

  /// Forgets the history: the next BDF2 step is an Euler step. For the start and after a jump.
  void restart() { history_.h = 0; }

  /// The history, of so many particles. Throws std::runtime_error where it cannot be.
  template <class Archive>
  void serialize(Archive& archive, std::size_t particles) {
    archive.value(history_.h);
    if constexpr (Archive::kReads) require(history_.h >= 0 && std::isfinite(history_.h), "a step length");
    if (history_.h == 0) return;
    serialize_points(archive, history_.before.x, particles);
    serialize_points(archive, history_.before.v, particles);
  }

 private:
  struct Stage {
    double beta;      // [s]
    double end_rate;  // dx_end/dx: 1, or 2 for the midpoint rule
  };
  /// A cloth, or whatever the matrix does not couple with the rest.
  struct PartState {
    solver::Part rows;
    double mass = 0;            // [kg]
    double local_error = 0;     // of the method, at the current iterate [m]
    double velocity_error = 0;  // likewise of the velocity, where it is known [m/s]
    double allowed = 0;         // velocity that may be left [m/s]
    double left = 0;            // velocity that is left [m/s]
    double rounding = 0;        // velocity that is lost in the roundings of its positions [m/s]
    bool is_held = false;       // somewhere, against sliding too
    double may_slide = 0;       // velocity of all of it by which friction may be off [m/s]
    double slides = 0;          // by which it is off, where it is about to slide [m/s]

    // Of what is left over what may be.
    double excess() const { return std::max(left / allowed, slides / may_slide); }
  };

  bool is_first_order(double h) const;
  Stage begin(const State& now, double h);
  void prepare_guess(const System& system, const State& now, const Stage& stage, double h, const Vec3& gravity);
  void hold(const State& now, const Stage& stage, std::span<const HeldParticle> held,
            std::vector<solver::ParticleConstraint>& constraints);
  void list_parts(std::span<const double> masses, const State& now, const solver::LinearSystem& linear);
  std::span<const Vec3> likely_change(std::span<const double> masses, const State& now);
  solver::LinearReport solve_linear(std::span<const Vec3> start, std::span<const Vec3> x0);
  double search_along_delta(System& system, const State& now, const Stage& stage);
  enum class Equation { itself, linear };
  void linearise(System& system, const State& now, const Stage& stage, int iteration);
  void residual(System& system, const State& now, const Stage& stage, Equation equation);
  void evaluate(const State& now, const Stage& stage);
  void gather_residual(std::span<const double> masses, const Stage& stage);
  void estimate_local_errors(std::span<const double> masses, const State& now, const Stage& stage, double h);
  void allow_velocities(double h, int iterations);
  static double root_mean_square(const PartState& part, std::span<const double> masses, std::span<const Vec3> of);
  void balance_momentum(std::span<const double> masses, const solver::LinearSystem& linear, const Stage& stage);
  std::span<const Vec3> precondition(std::span<const Vec3> residual);
  void measure(std::span<const Vec3> displacements, std::span<const double> masses, std::vector<double>& speeds) const;
  void estimate_left(const solver::LinearReport& solved, double fraction, std::span<const double> masses);
  void estimate_slides(const System& system, const Stage& stage);
  void select_unsolved(int iterations);
  bool is_solved(int iterations) const;
  void report_worst(StepReport& report) const;
  void finish(const State& now, const Stage& stage, std::span<const HeldParticle> held, State& next) const;
  void split_impacts(System& system, const State& now, const Stage& stage, double h);
  Vec3 v_end(const State& now, const Stage& stage, std::size_t i) const;

  Method method_;
  NewtonParameters parameters_;
  History history_;
  double beta_ = 0;     // of the last stage [s]
  int unfinished_ = 0;  // iterations of the last solve, where that ended for a look

  // Scratch of one step.
  StageTimes times_;
  solver::ConjugateGradient cg_;
  Sliding sliding_;
  std::vector<PartState> parts_;
  std::vector<std::size_t> unsolved_;
  // Per part: energy norms that may be left, and velocities [m/s].
  std::vector<double> goals_, foreseen_, changes_, speeds_;
  std::vector<Past> past_;
  std::vector<Vec3> x_hat_, v_hat_, x_, v_, x_end_, constant_force_, force_, residual_, delta_, line_start_, motion_,
      drift_, scratch_;
  // What impacts change of velocities [m/s], and the velocities at the end of the solve; of BDF2 alone.
  std::vector<Vec3> jumps_, solved_v_;
};

}  // namespace weft::integrator
