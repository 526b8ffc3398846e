#include "physics/integrator/stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics.hpp"
#include "core/stop.hpp"
#include "physics/integrator/momentum.hpp"
#include "physics/integrator/particle_loops.hpp"

namespace weft::integrator {
namespace {

// Lower bound of the allowed position error, in units of the rounding error of the block's largest coordinate.
constexpr double kMinRoundings = 32;

// The largest coordinate of a block, as absolute value [m].
double largest_coordinate(const solver::DiagonalBlock& rows, std::span<const Vec3> x) {
  const auto of_block =
      x.subspan(static_cast<std::size_t>(rows.begin), static_cast<std::size_t>(rows.end - rows.begin));
  return parallel_max(of_block.size(), kGrainSize, 0.0, [&](std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, of_block[i].cwiseAbs().maxCoeff());
    return largest;
  });
}

}  // namespace

std::string_view describe(Verdict verdict) {
  // In the order of the enumeration.
  static constexpr std::array<std::string_view, 5> kWords{
      "solved", "not yet solved", "a position or force is not finite", "Newton's method did not reach its tolerance",
      "the linear system is not positive definite"};
  return kWords[static_cast<std::size_t>(verdict)];
}

Stepper::Stage Stepper::begin(const State& now, double h) {
  const std::size_t n = now.v.size();
  for (auto* vector : {&x_hat_, &v_hat_, &x_, &v_, &x_end_, &constant_force_, &force_, &residual_, &delta_, &scratch_})
    vector->resize(n);
  std::copy_n(now.x.begin(), n, x_hat_.begin());
  v_hat_ = now.v;
  past_.clear();
  if (method_ == Method::implicit_midpoint) return {0.5 * h, 2};
  past_.push_back({{now.x.data(), n}, 1});
  if (is_first_order(h)) return {h, 1};

  // BDF2 with variable steps.
  const double r = h / history_.h;
  const double now_weight = (1 + r) * (1 + r) / (1 + 2 * r), before_weight = r * r / (1 + 2 * r);
  for_each_particle(n, [&](std::size_t i) {
    x_hat_[i] = now_weight * now.x[i] - before_weight * history_.before.x[i];
    v_hat_[i] = now_weight * now.v[i] - before_weight * history_.before.v[i];
  });
  past_ = {{{now.x.data(), n}, now_weight}, {history_.before.x, -before_weight}};
  return {h * (1 + r) / (1 + 2 * r), 1};
}

// Computes v_ and x_end_ from x_, and sets force_ to zero.
void Stepper::evaluate(const State& now) {
  for_each_particle(x_.size(), [&](std::size_t i) {
    v_[i] = (x_[i] - x_hat_[i]) / stage_.beta;
    x_end_[i] = now.x[i] + stage_.end_rate * (x_[i] - now.x[i]);
    force_[i].setZero();
  });
}

void Stepper::gather_residual(std::span<const double> masses) {
  for_each_particle(x_.size(), [&](std::size_t i) {
    residual_[i] = force_[i] + constant_force_[i] - (masses[i] / stage_.beta) * (v_[i] - v_hat_[i]);
  });
  cg_.filter(residual_);
}

void Stepper::linearise(System& system, const State& now, int iteration) {
  const Stopwatch watch(times_.forces);
  evaluate(now);
  system.linearise(stage_point(), iteration, force_);
}

// Returns the preconditioner times the residual. Valid until the next call.
std::span<const Vec3> Stepper::precondition(std::span<const Vec3> residual) {
  const Stopwatch watch(times_.preconditioner);
  return cg_.precondition(residual);
}

// Computes the residual at x_, from System::forces() or System::linear_forces().
void Stepper::residual(System& system, const State& now, Equation equation) {
  const Stopwatch watch(times_.forces);
  evaluate(now);
  const StagePoint at = stage_point();
  equation == Equation::itself ? system.forces(at, force_) : system.linear_forces(at, force_);
  gather_residual(system.masses());
}

// Sets `allowed` of each block: the velocity error that the solver may leave [m/s], root mean square over its mass.
// During the time `error_duration`, this error displaces the block by `tolerance` · max(local error of positions,
// visibility threshold). If the bound used h in place of `error_duration`, the solver could add this
// displacement in every step, and with adaptive step sizes the method would lose one order. From
// `slow_after` iterations on, the local velocity error of implicit Euler may raise the bound. The
// bound never falls below rounding.
void Stepper::update_tolerances(double h, int iterations) {
  const double time = numerics.newton.error_duration;
  double unseen = numerics.newton.min_visible_acceleration * h * time;
  if (parameters_.position_tolerance > 0) unseen = std::min(unseen, parameters_.position_tolerance);
  for (BlockState& block : blocks_) {
    double error = std::max(block.local_error, unseen) / time;
    if (iterations >= numerics.newton.slow_after)
      error = std::max(error, numerics.newton.velocity_ratio * block.velocity_error);
    block.allowed = std::max(parameters_.tolerance * error, block.rounding);
  }
}

// Root mean square of the vectors `of` over the mass of a block.
double Stepper::root_mean_square(const BlockState& block, std::span<const double> masses, std::span<const Vec3> of) {
  const double sum = sum_over_particles(block.rows, [&](std::size_t i) { return masses[i] * of[i].squaredNorm(); });
  return std::sqrt(sum / block.mass);
}

// Root mean square over mass of displacement / β of each block [m/s].
void Stepper::compute_rms_speeds(std::span<const Vec3> displacements, std::span<const double> masses,
                                 std::vector<double>& speeds) const {
  speeds.clear();
  for (const BlockState& block : blocks_)
    speeds.push_back(root_mean_square(block, masses, displacements) / stage_.beta);
}

// Estimates the velocity error of each block after a linear solve and a line search. The linear
// solver reports its own error. The nonlinear error is known only as a residual; the preconditioner
// converts this residual to a displacement that is too small. The ratio of the last solution to its
// preconditioned right hand side, if above 1, corrects this displacement. If the line search did
// not take the full step, or the matrix is indefinite, the residual contains both errors.
void Stepper::estimate_remaining_velocities(const solver::LinearReport& solved, double fraction,
                                            std::span<const double> masses) {
  const bool is_full_step = fraction == 1 && solved.definite;
  for_each_particle(scratch_.size(), [&](std::size_t i) { scratch_[i] = residual_[i]; });
  if (is_full_step)
    for (std::size_t p : unsolved_)
      for_each_particle(blocks_[p].rows, [&](std::size_t i) { scratch_[i] -= cg_.residual()[i]; });
  compute_rms_speeds(delta_, masses, solved_speeds_);
  compute_rms_speeds(precondition(scratch_), masses, speeds_);
  for (std::size_t p = 0; p < blocks_.size(); ++p)
    blocks_[p].remaining_error =
        speeds_[p] * (predicted_speeds_[p] > 0 ? std::max(1.0, solved_speeds_[p] / predicted_speeds_[p]) : 1);
  if (is_full_step)
    for (std::size_t p : unsolved_)
      blocks_[p].remaining_error =
          std::hypot(blocks_[p].remaining_error, solved.errors[p] / std::sqrt(blocks_[p].mass));
}

// Estimates the velocity error of whole blocks from wrong friction, for blocks that otherwise count
// as solved and that no constraint holds against sliding. Friction can at most stop a block.
// Therefore the error is at most the velocity that the block would have at the stage under constant
// forces alone, however large the force of a stiff contact is.
void Stepper::estimate_sliding_errors(const System& system) {
  const auto masses = system.masses();
  const auto needs_check = [](const BlockState& block) {
    return !block.holds_sliding && block.remaining_error <= block.allowed;
  };
  const bool any = std::ranges::any_of(blocks_, needs_check) && sliding_.evaluate(system, stage_point());
  for (BlockState& block : blocks_) {
    block.sliding_error =
        any && needs_check(block) ? sliding_.friction_error(block.rows, residual_) * stage_.beta / block.mass : 0;
    if (block.sliding_error == 0) continue;
    for_each_particle(block.rows,
                      [&](std::size_t i) { scratch_[i] = v_hat_[i] + stage_.beta / masses[i] * constant_force_[i]; });
    block.sliding_error = std::min(block.sliding_error, root_mean_square(block, masses, scratch_));
  }
}

// Bounds the work that the remaining residual does in the step, because norms of velocity hardly contain the error of
// stiff motion (measured without this bound: an impact at 38 m/s stretches threads by 75 % instead of 24 %, and the
// residual does as much work as the cloth has energy). If the work exceeds the bound, the allowed
// error is reduced by the same ratio.
void Stepper::bound_work(std::span<const double> masses, const State& now) {
  for (BlockState& block : blocks_) {
    const double work =
        std::abs(sum_over_particles(block.rows, [&](std::size_t i) { return residual_[i].dot(x_end_[i] - now.x[i]); }));
    const double kinetic =
        0.5 * sum_over_particles(block.rows, [&](std::size_t i) { return masses[i] * v_[i].squaredNorm(); });
    const double most = numerics.energy.doubtful_gain * kinetic + numerics.energy.negligible * block.mass;
    block.work_error = work > most ? block.allowed : 0;
    if (work > most) block.allowed = std::max(block.allowed * most / work, block.rounding);
  }
}

bool Stepper::is_solved(int iterations) const {
  double unseen_speed = iterations < numerics.newton.slow_after ? 0 : numerics.newton.min_visible_velocity();
  if (parameters_.position_tolerance > 0)
    unseen_speed = std::min(unseen_speed, parameters_.position_tolerance / numerics.newton.error_duration);
  unseen_speed *= parameters_.tolerance;
  return std::ranges::all_of(
      blocks_, [&](const BlockState& block) { return block.error() <= std::max(block.allowed, unseen_speed); });
}

// Selects the blocks that the next linear solve includes.
void Stepper::select_unsolved(int iterations) {
  unsolved_.clear();
  for (std::size_t p = 0; p < blocks_.size(); ++p)
    if (iterations >= numerics.newton.slow_after / 2 ||
        blocks_[p].error() > numerics.newton.linear_fraction * blocks_[p].allowed)
      unsolved_.push_back(p);
}

// Line search along delta_: moves x_ by delta_; by less if delta_ overshoots the minimum of the
// step's energy, by more if delta_ hardly approaches the minimum. Returns the factor of delta_; if
// a slope is not finite, returns that slope.
double Stepper::search_along_delta(System& system, const State& now) {
  // The residual is minus the gradient of the step's energy (if there is one), so residual · delta is minus the slope
  // of the energy: positive before the minimum along delta, negative after it. If contacts begin or compressed edges
  // come under tension on the way, the product becomes strongly negative; full steps would then oscillate. If friction
  // and compression make the matrix too stiff, the product hardly decreases.
  const std::size_t n = x_.size();
  const double start_slope = dot(residual_, delta_);
  line_start_.swap(x_);
  x_.resize(n);
  double fraction = 1, low = 0, low_slope = start_slope, high = 0, high_slope = 0;
  for (int trial = 1;; ++trial) {
    for_each_particle(n, [&](std::size_t i) { x_[i] = line_start_[i] + fraction * delta_[i]; });
    residual(system, now, Equation::linear);
    const double slope = dot(residual_, delta_);
    if (!std::isfinite(slope)) return slope;
    if (std::abs(slope) <= numerics.newton.slope_left * std::abs(start_slope) || trial == numerics.newton.line_trials)
      break;
    if (slope < 0)
      high = fraction, high_slope = slope;
    else
      low = fraction, low_slope = slope;
    if (high == 0) {
      if (trial == numerics.newton.line_trials / 2) break;
      fraction *= 2;
    } else {
      // Regula falsi, kept away from the ends of the bracket.
      const double guess = low + (high - low) * low_slope / (low_slope - high_slope);
      fraction = std::clamp(guess, low + 0.1 * (high - low), high - 0.1 * (high - low));
    }
  }
  return fraction;
}

// Sets x_ to the initial guess (unchanged velocity), and constant_force_ to the constant forces, weight included.
void Stepper::prepare_guess(const System& system, const State& now, double h, const Vec3& gravity) {
  const auto masses = system.masses();
  for_each_particle(x_.size(), [&](std::size_t i) {
    x_[i] = now.x[i] + h / stage_.end_rate * now.v[i];
    constant_force_[i] = masses[i] * gravity;
  });
  system.constant_forces(constant_force_);
}

// Predicts the direction of velocity changes, along which the first linear solve starts: that of
// the last step or, without a history, that of the constant forces per mass. Thus the motion of
// cloth that falls, slides or drifts uniformly is exact at any linear tolerance, and flat sheets
// stay flat.
std::span<const Vec3> Stepper::predict_velocity_change(std::span<const double> masses, const State& now) {
  for_each_particle(masses.size(), [&](std::size_t i) {
    scratch_[i] = history_.h > 0 ? Vec3(now.v[i] - history_.before.v[i]) : Vec3(constant_force_[i] / masses[i]);
  });
  return scratch_;
}

// Moves held particles to their targets at the stage, along the held directions only.
void Stepper::apply_constraints(const State& now, std::span<const HeldParticle> held,
                                std::vector<solver::ParticleConstraint>& constraints) {
  constraints.clear();
  for (const HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    const Vec3 target = now.x[i] + (particle.x_end - now.x[i]) / stage_.end_rate;
    x_[i] = target + particle.constraint.free * (x_[i] - target);
    constraints.push_back(particle.constraint);
  }
}

StepReport Stepper::step(System& system, const State& now, double h, const Vec3& gravity,
                         std::span<const HeldParticle> held, State& next, Start start, int pause_after) {
  const std::size_t n = now.v.size();
  solver::LinearSystem& linear = system.linear_system();
  const auto masses = system.masses();
  stage_ = begin(now, h);
  linear.norm_weights.resize(n);
  for_each_particle(n, [&](std::size_t i) { linear.norm_weights[i] = masses[i] / (stage_.beta * stage_.beta); });
  prepare_guess(system, now, h, gravity);
  if (start == Start::next)
    for (std::size_t i = 0; i < n; ++i) x_[i] = now.x[i] + (next.x[i] - now.x[i]) / stage_.end_rate;
  next.x.resize(now.x.size());
  next.v.resize(n);
  apply_constraints(now, held, linear.constraints);
  collect_blocks(masses, now, linear);

  const int previous_iterations = start == Start::next ? std::exchange(iterations_before_pause_, 0) : 0;
  StepReport report;
  times_ = {};
  bool solved_all = false;
  do {
    end_if_stopped();
    linearise(system, now, previous_iterations + report.newton_iterations);
    // Later iterations reuse the sums over aggregates, because the stiffness of long waves hardly changes in a solve.
    {
      const Stopwatch watch(times_.preconditioner);
      cg_.prepare(linear,
                  report.newton_iterations == 0 ? solver::AggregateSums::recompute : solver::AggregateSums::reuse);
    }
    gather_residual(masses);
    if (report.newton_iterations == 0) {  // before a later iteration, the end of the previous one has done this
      estimate_local_errors(masses, now, h);
      update_tolerances(h, previous_iterations);
    }
    compute_rms_speeds(precondition(residual_), masses, predicted_speeds_);
    const bool first = previous_iterations + report.newton_iterations == 0;
    const solver::LinearReport solved =
        solve_linear(first ? predict_velocity_change(masses, now) : std::span<const Vec3>(), now.x);
    ++report.newton_iterations;
    report.linear_iterations += solved.iterations;

    const double fraction = search_along_delta(system, now);
    if (!std::isfinite(fraction)) {
      report.verdict = Verdict::not_finite;
      break;
    }
    residual(system, now, Equation::itself);
    estimate_local_errors(masses, now, h);
    update_tolerances(h, previous_iterations + report.newton_iterations);
    bound_work(masses, now);
    estimate_remaining_velocities(solved, fraction, masses);
    estimate_sliding_errors(system);
    select_unsolved(report.newton_iterations);
    report_worst(report);
    solved_all = is_solved(previous_iterations + report.newton_iterations);
    if (!solved_all && !solved.definite)
      report.verdict = Verdict::indefinite;
    else if (!solved_all && report.newton_iterations >= parameters_.max_iterations)
      report.verdict = Verdict::newton_stalled;
    else if (!solved_all && report.newton_iterations >= pause_after)
      report.verdict = Verdict::unfinished;
  } while (!solved_all && report.verdict == Verdict::solved);
  iterations_before_pause_ = report.verdict == Verdict::unfinished ? report.newton_iterations : 0;
  if (report.verdict == Verdict::solved && system.is_translation_invariant()) balance_momentum(masses, linear);
  impact_changes_.clear();
  if (method_ == Method::bdf2 && report.verdict == Verdict::solved) split_impacts(system, now, h, report);
  report.times = times_;
  if (report.verdict != Verdict::solved && report.verdict != Verdict::unfinished) return report;
  write_end_state(now, h, held, next);
  if (method_ == Method::bdf2) solved_v_ = next.v;
  return report;
}

void Stepper::collect_blocks(std::span<const double> masses, const State& now, const solver::LinearSystem& linear) {
  blocks_.clear();
  unsolved_.clear();
  for (const solver::DiagonalBlock& rows : solver::blocks_of(linear)) {
    BlockState& block = blocks_.emplace_back();
    block.rows = rows;
    for (auto i = rows.begin; i < rows.end; ++i) block.mass += masses[i];
    block.rounding =
        kMinRoundings * std::numeric_limits<double>::epsilon() * largest_coordinate(rows, now.x) / stage_.beta;
    block.holds_sliding = is_held(rows, linear.constraints);
    // The first iteration solves all blocks. Otherwise, cloth that creeps slower than the tolerance would never come to
    // rest.
    unsolved_.push_back(unsolved_.size());
  }
}

// Makes the residual of each group that nothing holds sum to zero; see missing_accelerations().
void Stepper::balance_momentum(std::span<const double> masses, const solver::LinearSystem& linear) {
  const std::vector<Vec3> missing = missing_accelerations(linear, masses, residual_);
  for (std::size_t p = 0; p < blocks_.size(); ++p) {
    if (missing[p] == Vec3::Zero()) continue;
    for_each_particle(blocks_[p].rows, [&](std::size_t i) {
      v_[i] += stage_.beta * missing[p];
      x_end_[i] += stage_.end_rate * stage_.beta * stage_.beta * missing[p];
    });
  }
}

// Solves the linear system for the unsolved blocks. `start`: see solver::Directions. The remaining
// residual of the linear system does no work along the displacements β v = x − x̂ of the stage
// (`motion_`). With BDF2, it does no work along the displacements x − x0 of the step either (the
// sum of `motion_` and `drift_`).
solver::LinearReport Stepper::solve_linear(std::span<const Vec3> start, std::span<const Vec3> x0) {
  goals_.clear();
  const double tightening = method_ == Method::implicit_midpoint ? numerics.newton.midpoint_tightening : 1;
  const double fraction = tightening * numerics.newton.linear_fraction;
  for (const BlockState& block : blocks_) goals_.push_back(fraction * block.allowed * std::sqrt(block.mass));
  motion_.resize(x_.size());
  for_each_particle(x_.size(), [&](std::size_t i) { motion_[i] = x_[i] - x_hat_[i]; });
  drift_.resize(past_.size() > 1 ? x_.size() : 0);
  for_each_particle(drift_.size(), [&](std::size_t i) { drift_[i] = x_hat_[i] - x0[i]; });
  const Stopwatch watch(times_.linear);
  return cg_.solve(residual_, {tightening * parameters_.linear_tolerance, goals_}, parameters_.max_linear_iterations,
                   delta_, {start, motion_, drift_}, unsolved_);
}

void Stepper::report_worst(StepReport& report) const {
  const double time = numerics.newton.error_duration;
  report.local_error = report.solver_error = 0;
  double worst = -1;
  for (const BlockState& block : blocks_) {
    report.local_error = std::max(report.local_error, block.local_error);
    report.solver_error = std::max(report.solver_error, block.error() * time);
    if (block.error() / block.allowed <= worst) continue;
    worst = block.error() / block.allowed;
    report.remaining_error = block.error();
    report.allowed = block.allowed;
  }
}

void Stepper::write_end_state(const State& now, double h, std::span<const HeldParticle> held, State& next) const {
  for_each_particle(x_.size(), [&](std::size_t i) {
    next.x[i] = x_end_[i];
    next.v[i] = v_end(now, i);
    if (!impact_changes_.empty()) next.v[i] += (1 - h / stage_.beta) * impact_changes_[i];
  });
  for (const HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    const Mat3& free = particle.constraint.free;
    next.x[i] = particle.x_end + free * (next.x[i] - particle.x_end);
    next.v[i] = particle.v_end + free * (next.v[i] - particle.v_end);
  }
}

Vec3 Stepper::v_end(const State& now, std::size_t i) const {
  return stage_.end_rate == 1 ? v_[i] : Vec3(2 * v_[i] - now.v[i]);
}

// Estimates local errors at the current iterate. For the formulas of positions see Stepper.
void Stepper::estimate_local_errors(std::span<const double> masses, const State& now, double h) {
  const bool first_order = is_first_order(h);
  const double r = first_order ? 1 : h / history_.h;
  const bool bdf2 = method_ == Method::bdf2;
  const double gain_factor = bdf2 ? 0.75 * h : 0.5 * h;
  const double change_factor = bdf2 ? h * h * (1 + r) / (2 * (1 + 2 * r)) : h * h * r / (6 * (1 + r));
  for_each_particle(masses.size(), [&](std::size_t i) {
    const Vec3 gain = v_end(now, i) - now.v[i];
    if (first_order)
      scratch_[i] = gain_factor * gain;
    else
      scratch_[i] = change_factor * (gain / h - (now.v[i] - history_.before.v[i]) / history_.h);
  });
  cg_.filter(scratch_);
  for (BlockState& block : blocks_) block.local_error = root_mean_square(block, masses, scratch_);
  if (method_ != Method::implicit_euler || history_.h == 0) return;
  for_each_particle(masses.size(), [&](std::size_t i) {
    scratch_[i] = 0.5 * (v_[i] - now.v[i] - h / history_.h * (now.v[i] - history_.before.v[i]));
  });
  cg_.filter(scratch_);
  for (BlockState& block : blocks_) block.velocity_error = root_mean_square(block, masses, scratch_);
}

Vec3 Stepper::constraint_force(Index particle, double mass) const {
  const auto i = static_cast<std::size_t>(particle);
  return mass / stage_.beta * (v_[i] - v_hat_[i]) - force_[i] - constant_force_[i];
}

// Whether a step over h is an Euler step, or its error is estimated as that of one.
bool Stepper::is_first_order(double h) const {
  return method_ == Method::implicit_euler || history_.h == 0 ||
         (method_ == Method::bdf2 && h > (1 + kRoundoff) * kMaxStepRatio * history_.h);
}

double Stepper::longest_step() const {
  const bool bounded = method_ == Method::bdf2 && history_.h > 0;
  return bounded ? kMaxStepRatio * history_.h : std::numeric_limits<double>::infinity();
}

void Stepper::accept(const State& before, const State& after, double h) {
  history_.before.x.assign(before.x.begin(), before.x.begin() + std::ssize(before.v));
  history_.before.v = before.v;
  history_.h = h;
  if (method_ != Method::bdf2) return;
  for_each_particle(before.v.size(), [&](std::size_t i) {
    history_.before.v[i] += after.v[i] - solved_v_[i];
    if (!impact_changes_.empty()) history_.before.v[i] += impact_changes_[i];
  });
}

}  // namespace weft::integrator
