// One implicit time step (seed, Fig. 2): method → implicit equation → Newton with residual control → constrained CG.
#pragma once

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "core/archive.hpp"
#include "integrator/system.hpp"
#include "solver/conjugate_gradient.hpp"

namespace weft::integrator {

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

struct NewtonParameters {
  /// The step is solved when the residual is below this share of the particles' weight (of m · 1 m/s² where there is
  /// less gravity) or of the force that changes their velocity, whichever is more; all in the preconditioner's norm.
  /// Not relative to the first residual: where a first guess runs into an obstacle that is large, and what it would let
  /// pass is felt as drag (the falling band fell at a third of its speed).
  double tolerance = 0.3;
  int max_iterations = 60;
  double linear_tolerance = 0.1;  ///< of one linear solve, relative to its own right hand side
  int max_linear_iterations = 1000;
  /// Where the local error of a step is held below a tolerance, that tolerance [m]; 0: nowhere. The residual is then
  /// also below what would matter beside it: see Stepper::residual_that_matters().
  double position_tolerance = 0;
};

enum class Verdict { solved, not_finite, newton_stalled, indefinite };
std::string_view describe(Verdict verdict);

struct StepReport {
  Verdict verdict = Verdict::solved;
  int newton_iterations = 0;
  int linear_iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< weighed norms; comparable within one step
  double local_error = 0;                        ///< estimate of what this step adds to the error of positions [m]
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

  /// Where the search for the end of a step starts: at unchanged velocity, or at what `next` holds, for a step that is
  /// solved once more with other contacts.
  enum class Start { unchanged_velocity, next };

  /// Computes `next` from `now` over h [s]. Nothing is remembered: see accept().
  /// `gravity` [m/s²] acts on all particles and is also what residuals are measured against.
  StepReport step(System& system, const State& now, double h, const Vec3& gravity, std::span<const HeldParticle> held,
                  State& next, Start start = Start::unchanged_velocity);

  /// Force [N] with which its constraint acted on a particle of this mass [kg] at the end of the last step computed.
  Vec3 constraint_force(Index particle, double mass) const;

  /// Makes `before`, the state at the start of the step over h just accepted, the history of the next step.
  void accept(const State& before, double h);

  /// Longest step that may follow the last one accepted [s]; infinite where the method has no bound.
  double longest_step() const;

  /// Forgets the history: the next BDF2 step is an Euler step. For the start and after a jump.
  void restart() { previous_h_ = 0; }

  /// The history, of so many particles. Throws std::runtime_error where it cannot be.
  template <class Archive>
  void exchange(Archive& archive, std::size_t particles) {
    archive.value(previous_h_);
    if constexpr (Archive::kReads) require(previous_h_ >= 0 && std::isfinite(previous_h_), "a step length");
    if (previous_h_ == 0) return;
    exchange_points(archive, previous_.x, particles);
    exchange_points(archive, previous_.v, particles);
  }

 private:
  struct Stage {
    double beta, end_rate;
    double extrapolation;  // of the explicit forces: fraction of h at which the stage lies
  };
  Stage begin(const State& now, double h);
  void prepare_guess(const System& system, const State& now, const Stage& stage, double h, const Vec3& gravity);
  void hold(const State& now, const Stage& stage, std::span<const HeldParticle> held,
            std::vector<solver::ParticleConstraint>& constraints);
  double weight(std::span<const double> masses, const Vec3& gravity);
  double force_scale(std::span<const double> masses, double weight, const Stage& stage);
  double residual_that_matters(std::span<const double> masses, double h, const Stage& stage,
                               std::span<const solver::Part> parts) const;
  double local_error(std::span<const double> masses, const State& now, const State& next, double h,
                     std::span<const solver::Part> parts);
  std::span<const std::size_t> unsolved_parts(double goal);
  double search_along_delta(System& system, const State& now, const Stage& stage);
  double residual(System& system, const State& now, const Stage& stage);
  void evaluate(const State& now, const Stage& stage);
  void gather_residual(std::span<const double> masses, const Stage& stage);

  Method method_;
  NewtonParameters parameters_;
  State previous_;
  double previous_h_ = 0;  // 0: no history
  double beta_ = 0;        // of the last stage [s]

  // Scratch of one step.
  solver::ConjugateGradient cg_;
  State guess_;
  std::vector<std::size_t> unsolved_;
  std::vector<Vec3> x_hat_, v_hat_, x_, v_, x_end_, constant_force_, force_, residual_, delta_, line_start_, scale_;
};

}  // namespace weft::integrator
