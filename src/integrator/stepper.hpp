// One implicit time step (seed, Fig. 2): method → implicit equation → Newton with residual control → constrained CG.
#pragma once

#include <span>
#include <string_view>
#include <vector>

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
};

enum class Verdict { solved, not_finite, newton_stalled, indefinite };
std::string_view describe(Verdict verdict);

struct StepReport {
  Verdict verdict = Verdict::solved;
  int newton_iterations = 0;
  int linear_iterations = 0;
  double first_residual = 0, last_residual = 0;  ///< weighed norms; comparable within one step
};

/// Every method is one implicit stage  x = x̂ + β v,  M (v − v̂) = β f(x, v)  with its own β, x̂ and v̂:
///
///     method     β              x̂, v̂                                         end of the step
///     Euler      h              x0, v0                                       the stage
///     midpoint   h/2            x0, v0                                       2 · stage − start
///     BDF2       h(1+r)/(1+2r)  ((1+r)² y0 − r² y₋)/(1+2r), r = h/h₋         the stage
///
/// Checked on x'' = −ω² x against the exact damping and phase of each (tests/integrator).
class Stepper {
 public:
  Stepper(Method method, const NewtonParameters& parameters) : method_(method), parameters_(parameters) {}

  /// Where the search for the end of a step starts: at unchanged velocity, or at what `next` holds, for a step that is
  /// solved once more with other contacts.
  enum class Start { unchanged_velocity, next };

  /// Computes `next` from `now` over h [s]. Nothing is remembered: see accept().
  /// `gravity` [m/s²] acts on all particles and is also what residuals are measured against.
  StepReport step(const System& system, const State& now, double h, const Vec3& gravity,
                  std::span<const HeldParticle> held, solver::LinearSystem& scratch, State& next,
                  Start start = Start::unchanged_velocity);

  /// Force [N] with which its constraint acted on a particle of this mass [kg] at the end of the last step computed.
  Vec3 constraint_force(Index particle, double mass) const;

  /// Makes `before`, the state at the start of the step over h just accepted, the history of the next step.
  void accept(const State& before, double h);

  /// Forgets the history: the next BDF2 step is an Euler step. For the start and after a jump.
  void restart() { previous_h_ = 0; }

 private:
  struct Stage {
    double beta, end_rate;
    double extrapolation;  // of the explicit forces: fraction of h at which the stage lies
  };
  Stage begin(const State& now, double h);
  void prepare_guess(const System& system, const State& now, const Stage& stage, double h, const Vec3& gravity);
  void hold(const State& now, const Stage& stage, std::span<const HeldParticle> held, solver::LinearSystem& scratch);
  double weight(std::span<const double> masses, const Vec3& gravity);
  double force_scale(std::span<const double> masses, double weight, const Stage& stage);
  std::span<const std::size_t> unsolved_parts(double goal);
  double search_along_delta(const System& system, const State& now, const Stage& stage);
  double residual(const System& system, const State& now, const Stage& stage);
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
