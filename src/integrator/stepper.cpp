#include "integrator/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics.hpp"
#include "core/stop.hpp"
#include "integrator/momentum.hpp"
#include "integrator/particle_loops.hpp"

namespace weft::integrator {
namespace {

// Roundings of positions that no solver goes below.
constexpr double kRoundings = 32;

// The largest coordinate of a part [m].
double size_of(const solver::Part& rows, std::span<const Vec3> x) {
  const auto part = x.subspan(static_cast<std::size_t>(rows.begin), static_cast<std::size_t>(rows.end - rows.begin));
  return parallel_max(part.size(), kGrainSize, 0.0, [&](std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, part[i].cwiseAbs().maxCoeff());
    return largest;
  });
}

}  // namespace

std::string_view describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::solved:
      return "solved";
    case Verdict::unfinished:
      return "not yet solved";
    case Verdict::not_finite:
      return "a position or force is not finite";
    case Verdict::newton_stalled:
      return "Newton's method did not reach its tolerance";
    case Verdict::indefinite:
      return "the linear system is not positive definite";
  }
  return "unknown";
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

  // BDF2 with variable steps; those who choose them keep to longest_step().
  const double r = h / history_.h;
  const double now_weight = (1 + r) * (1 + r) / (1 + 2 * r), before_weight = r * r / (1 + 2 * r);
  for_each_particle(n, [&](std::size_t i) {
    x_hat_[i] = now_weight * now.x[i] - before_weight * history_.before.x[i];
    v_hat_[i] = now_weight * now.v[i] - before_weight * history_.before.v[i];
  });
  past_ = {{{now.x.data(), n}, now_weight}, {history_.before.x, -before_weight}};
  return {h * (1 + r) / (1 + 2 * r), 1};
}

// Brings v and x_end in line with x; forces are zero as yet.
void Stepper::evaluate(const State& now, const Stage& stage) {
  for_each_particle(x_.size(), [&](std::size_t i) {
    v_[i] = (x_[i] - x_hat_[i]) / stage.beta;
    x_end_[i] = now.x[i] + stage.end_rate * (x_[i] - now.x[i]);
    force_[i].setZero();
  });
}

void Stepper::gather_residual(std::span<const double> masses, const Stage& stage) {
  for_each_particle(x_.size(), [&](std::size_t i) {
    residual_[i] = force_[i] + constant_force_[i] - (masses[i] / stage.beta) * (v_[i] - v_hat_[i]);
  });
  cg_.filter(residual_);
}

// At the current stage.
void Stepper::linearise(System& system, const State& now, const Stage& stage, int iteration) {
  const Stopwatch watch(times_.forces);
  evaluate(now, stage);
  system.linearise({x_, v_, x_end_, 1 / stage.beta, stage.end_rate, past_}, iteration, force_);
}

// P⁻¹ of it, valid until the next call.
std::span<const Vec3> Stepper::precondition(std::span<const Vec3> residual) {
  const Stopwatch watch(times_.preconditioner);
  return cg_.precondition(residual);
}

// At the current stage: of the equation itself, or of what the last linearisation made of it.
void Stepper::residual(System& system, const State& now, const Stage& stage, Equation equation) {
  const Stopwatch watch(times_.forces);
  evaluate(now, stage);
  const StagePoint at{x_, v_, x_end_, 1 / stage.beta, stage.end_rate, past_};
  equation == Equation::itself ? system.forces(at, force_) : system.linear_forces(at, force_);
  gather_residual(system.masses(), stage);
}

// Velocity [m/s], root mean square over the mass of a part, that the solver may leave: what moves the part by
// `tolerance` times the method's error of position in this step, in `lasting_time`. A displacement of that size left in
// each step would not do: where steps h follow a tolerance as h^(p+1) it would cost the method an order.
void Stepper::allow_velocities(double h, int iterations) {
  const double time = numerics.newton.lasting_time;
  double unseen = numerics.newton.unseen_acceleration * h * time;
  if (parameters_.position_tolerance > 0) unseen = std::min(unseen, parameters_.position_tolerance);
  for (PartState& part : parts_) {
    double error = std::max(part.local_error, unseen) / time;
    if (iterations >= numerics.newton.patience)
      error = std::max(error, numerics.newton.velocity_ratio * part.velocity_error);
    part.allowed = std::max(parameters_.tolerance * error, part.rounding);
    part.may_slide = std::max(
        {numerics.newton.sliding_fraction * part.allowed, parameters_.tolerance * unseen / time, part.rounding});
  }
}

// Over the mass of a part.
double Stepper::root_mean_square(const PartState& part, std::span<const double> masses, std::span<const Vec3> of) {
  const double sum = sum_over_particles(part.rows, [&](std::size_t i) { return masses[i] * of[i].squaredNorm(); });
  return std::sqrt(sum / part.mass);
}

// Velocities of the parts, root mean square, that these displacements stand for [m/s].
void Stepper::measure(std::span<const Vec3> displacements, std::span<const double> masses,
                      std::vector<double>& speeds) const {
  speeds.clear();
  for (const PartState& part : parts_) speeds.push_back(root_mean_square(part, masses, displacements) / beta_);
}

// What is left of each part after a linear solve and a step along its solution. What the linear solve left is known
// from itself. What is left besides, because the equation is not linear, is known as a residual only. The
// preconditioner makes a displacement of it, as before the solve it made one of the right hand side: that was too small
// by a factor which the solution tells.
void Stepper::estimate_left(const solver::LinearReport& solved, double fraction, std::span<const double> masses) {
  const bool whole = fraction == 1 && solved.definite;
  for_each_particle(scratch_.size(), [&](std::size_t i) { scratch_[i] = residual_[i]; });
  if (whole)
    for (std::size_t p : unsolved_)
      for_each_particle(parts_[p].rows, [&](std::size_t i) { scratch_[i] -= cg_.residual()[i]; });
  measure(delta_, masses, changes_);
  measure(precondition(scratch_), masses, speeds_);
  for (std::size_t p = 0; p < parts_.size(); ++p)
    parts_[p].left = speeds_[p] * (foreseen_[p] > 0 ? std::max(1.0, changes_[p] / foreseen_[p]) : 1);
  if (whole)
    for (std::size_t p : unsolved_)
      parts_[p].left = std::hypot(parts_[p].left, solved.errors[p] / std::sqrt(parts_[p].mass));
}

// Velocities by which whole parts slide wrongly, where they would be solved otherwise. Friction can do no more than
// stop what a part has or gets in the step, however large a force a stiff contact makes of it.
void Stepper::estimate_slides(const System& system, const Stage& stage) {
  const auto masses = system.masses();
  const auto counts = [](const PartState& part) { return !part.is_held && part.left <= part.allowed; };
  const bool any = std::ranges::any_of(parts_, counts) &&
                   sliding_.evaluate(system, {x_, v_, x_end_, 1 / stage.beta, stage.end_rate});
  for (PartState& part : parts_) {
    part.slides = any && counts(part) ? sliding_.wrong_friction(part.rows, residual_) * stage.beta / part.mass : 0;
    if (part.slides == 0) continue;
    for_each_particle(part.rows,
                      [&](std::size_t i) { scratch_[i] = v_hat_[i] + stage.beta / masses[i] * constant_force_[i]; });
    part.slides = std::min(part.slides, root_mean_square(part, masses, scratch_));
  }
}

bool Stepper::is_solved(int iterations) const {
  double most = iterations < numerics.newton.patience ? 0 : parameters_.tolerance * numerics.newton.unseen_velocity;
  if (parameters_.position_tolerance > 0)
    most = std::min(most, parameters_.position_tolerance / numerics.newton.lasting_time);
  return std::ranges::all_of(parts_, [&](const PartState& part) {
    return part.left <= std::max(part.allowed, most) &&
           part.slides <= (iterations < numerics.newton.patience / 2 ? part.may_slide : std::max(part.allowed, most));
  });
}

// Parts that the next linear solve is for.
void Stepper::select_unsolved(int iterations) {
  unsolved_.clear();
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (iterations >= numerics.newton.patience / 2 || parts_[p].excess() > numerics.newton.linear_fraction)
      unsolved_.push_back(p);
}

// Moves x along delta_: the whole way, less where the whole way overshoots, or farther where it hardly gets nearer.
// Returns how far, not a number where a residual is not finite.
double Stepper::search_along_delta(System& system, const State& now, const Stage& stage) {
  // The residual is minus the gradient of the step's energy (where there is one), so residual · delta is the slope:
  // positive before the minimum along delta, negative behind. Where contacts or compressed edges switch on the way it
  // can turn steeply negative, and full steps would then go to and fro. Where friction and compression make the matrix
  // too stiff it stays as it was.
  const std::size_t n = x_.size();
  const double start_slope = dot(residual_, delta_);
  line_start_.swap(x_);
  x_.resize(n);
  double fraction = 1, low = 0, low_slope = start_slope, high = 0, high_slope = 0;
  for (int trial = 1;; ++trial) {
    for_each_particle(n, [&](std::size_t i) { x_[i] = line_start_[i] + fraction * delta_[i]; });
    residual(system, now, stage, Equation::linear);
    const double slope = dot(residual_, delta_);
    if (!std::isfinite(slope)) return slope;
    const bool short_of = slope > numerics.newton.undershoot * start_slope,
               beyond = slope < -numerics.newton.overshoot * start_slope;
    if (trial == numerics.newton.line_trials ||
        (!beyond && (high > 0 ? slope <= numerics.newton.overshoot * start_slope : !short_of)))
      break;
    if (beyond) {
      high = fraction, high_slope = slope;
    } else {
      low = fraction, low_slope = slope;
      if (high == 0 && fraction >= numerics.newton.longest_search) break;
    }
    if (high == 0) {
      fraction = low_slope < start_slope
                     ? std::min(numerics.newton.longest_search, fraction * start_slope / (start_slope - slope))
                     : numerics.newton.longest_search;
    } else {
      // Regula falsi, kept away from the ends.
      const double guess = low + (high - low) * low_slope / (low_slope - high_slope);
      fraction = std::clamp(guess, low + 0.1 * (high - low), high - 0.1 * (high - low));
    }
  }
  return fraction;
}

// First guess: unchanged velocity.
void Stepper::prepare_guess(const System& system, const State& now, const Stage& stage, double h, const Vec3& gravity) {
  const auto masses = system.masses();
  for_each_particle(x_.size(), [&](std::size_t i) {
    x_[i] = now.x[i] + h / stage.end_rate * now.v[i];
    constant_force_[i] = masses[i] * gravity;
  });
  system.constant_forces(constant_force_);
}

// The direction in which velocities are expected to change: as in the last step; at the start as constant forces have
// it. Cloth that falls, slides or is blown along uniformly is then exact however little is asked of the linear solver,
// and the flat sheet stays flat: as a residual that is far below the weight its rigid motion alone was left uneven.
std::span<const Vec3> Stepper::likely_change(std::span<const double> masses, const State& now) {
  for_each_particle(masses.size(), [&](std::size_t i) {
    scratch_[i] = history_.h > 0 ? Vec3(now.v[i] - history_.before.v[i]) : Vec3(constant_force_[i] / masses[i]);
  });
  return scratch_;
}

// Held directions start at their target and stay there.
void Stepper::hold(const State& now, const Stage& stage, std::span<const HeldParticle> held,
                   std::vector<solver::ParticleConstraint>& constraints) {
  constraints.clear();
  for (const HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    const Vec3 target = now.x[i] + (particle.x_end - now.x[i]) / stage.end_rate;
    x_[i] = target + particle.constraint.free * (x_[i] - target);
    constraints.push_back(particle.constraint);
  }
}

StepReport Stepper::step(System& system, const State& now, double h, const Vec3& gravity,
                         std::span<const HeldParticle> held, State& next, Start start, int look_after) {
  const std::size_t n = now.v.size();
  solver::LinearSystem& linear = system.linear_system();
  const auto masses = system.masses();
  const Stage stage = begin(now, h);
  beta_ = stage.beta;
  linear.metric.resize(n);
  for_each_particle(n, [&](std::size_t i) { linear.metric[i] = masses[i] / (stage.beta * stage.beta); });
  prepare_guess(system, now, stage, h, gravity);
  if (start == Start::next)
    for (std::size_t i = 0; i < n; ++i) x_[i] = now.x[i] + (next.x[i] - now.x[i]) / stage.end_rate;
  next.x.resize(now.x.size());
  next.v.resize(n);
  hold(now, stage, held, linear.constraints);
  list_parts(masses, now, linear);

  const int done = start == Start::next ? std::exchange(unfinished_, 0) : 0;
  StepReport report;
  times_ = {};
  bool solved_all = false;
  do {
    end_if_stopped();
    linearise(system, now, stage, done + report.newton_iterations);
    // Groups stand for long waves, whose stiffness hardly changes within a step.
    {
      const Stopwatch watch(times_.preconditioner);
      cg_.prepare(linear, report.newton_iterations == 0 ? solver::Sums::anew : solver::Sums::kept);
    }
    gather_residual(masses, stage);
    if (report.newton_iterations == 0) {  // else where the last one ended
      estimate_local_errors(masses, now, stage, h);
      allow_velocities(h, done);
    }
    measure(precondition(residual_), masses, foreseen_);
    const bool first = done + report.newton_iterations == 0;
    const solver::LinearReport solved =
        solve_linear(first ? likely_change(masses, now) : std::span<const Vec3>(), now.x);
    ++report.newton_iterations;
    report.linear_iterations += solved.iterations;

    const double fraction = search_along_delta(system, now, stage);
    if (!std::isfinite(fraction)) {
      report.verdict = Verdict::not_finite;
      break;
    }
    residual(system, now, stage, Equation::itself);
    estimate_local_errors(masses, now, stage, h);
    allow_velocities(h, done + report.newton_iterations);
    estimate_left(solved, fraction, masses);
    estimate_slides(system, stage);
    select_unsolved(report.newton_iterations);
    report_worst(report);
    solved_all = is_solved(done + report.newton_iterations);
    if (!solved_all && !solved.definite)
      report.verdict = Verdict::indefinite;
    else if (!solved_all && report.newton_iterations >= parameters_.max_iterations)
      report.verdict = Verdict::newton_stalled;
    else if (!solved_all && report.newton_iterations >= look_after)
      report.verdict = Verdict::unfinished;
  } while (!solved_all && report.verdict == Verdict::solved);
  report.times = times_;
  unfinished_ = report.verdict == Verdict::unfinished ? report.newton_iterations : 0;
  if (report.verdict == Verdict::solved && system.is_translation_invariant()) balance_momentum(masses, linear, stage);
  if (report.verdict != Verdict::solved && report.verdict != Verdict::unfinished) return report;
  jumps_.clear();
  if (method_ == Method::bdf2 && report.verdict == Verdict::solved) split_impacts(system, now, stage, h);
  finish(now, stage, held, next);
  if (method_ == Method::bdf2) solved_v_ = next.v;
  return report;
}

void Stepper::list_parts(std::span<const double> masses, const State& now, const solver::LinearSystem& linear) {
  parts_.clear();
  unsolved_.clear();
  for (const solver::Part& rows : solver::parts_of(linear)) {
    PartState& part = parts_.emplace_back();
    part.rows = rows;
    for (auto i = rows.begin; i < rows.end; ++i) part.mass += masses[i];
    part.rounding = kRoundings * std::numeric_limits<double>::epsilon() * size_of(rows, now.x) / beta_;
    part.is_held = is_held(rows, linear.constraints);
    // The first iteration is for all: cloth that creeps within the tolerance would never stop.
    unsolved_.push_back(unsolved_.size());
  }
}

// Keeps the momentum of cloth on which nothing acts from outside.
void Stepper::balance_momentum(std::span<const double> masses, const solver::LinearSystem& linear, const Stage& stage) {
  const std::vector<Vec3> missing = missing_accelerations(linear, masses, residual_);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (missing[p] == Vec3::Zero()) continue;
    for_each_particle(parts_[p].rows, [&](std::size_t i) {
      v_[i] += stage.beta * missing[p];
      x_end_[i] += stage.end_rate * stage.beta * stage.beta * missing[p];
    });
  }
}

// For the parts that are not solved. `start`: see solver::Directions. What is left does no work along velocities of the
// stage, β v = x − x̂, nor along the displacement of the step, x − x0, where that is another direction.
solver::LinearReport Stepper::solve_linear(std::span<const Vec3> start, std::span<const Vec3> x0) {
  goals_.clear();
  const double tighter = method_ == Method::implicit_midpoint ? numerics.newton.undamped : 1;
  const double fraction = tighter * numerics.newton.linear_fraction;
  for (const PartState& part : parts_) goals_.push_back(fraction * part.allowed * std::sqrt(part.mass));
  motion_.resize(x_.size());
  for_each_particle(x_.size(), [&](std::size_t i) { motion_[i] = x_[i] - x_hat_[i]; });
  drift_.resize(past_.size() > 1 ? x_.size() : 0);
  for_each_particle(drift_.size(), [&](std::size_t i) { drift_[i] = x_hat_[i] - x0[i]; });
  const Stopwatch watch(times_.linear);
  return cg_.solve(residual_, {tighter * parameters_.linear_tolerance, goals_}, parameters_.max_linear_iterations,
                   delta_, {start, motion_, drift_}, unsolved_);
}

// What is left and may be left of the worst part.
void Stepper::report_worst(StepReport& report) const {
  const double time = numerics.newton.lasting_time;
  report.local_error = report.solver_error = 0;
  double worst = -1;
  for (const PartState& part : parts_) {
    report.local_error = std::max(report.local_error, part.local_error);
    report.solver_error = std::max({report.solver_error, part.left * time, part.slides * time});
    if (part.excess() <= worst) continue;
    worst = part.excess();
    const bool is_loose = part.left * part.may_slide >= part.slides * part.allowed;
    report.left = is_loose ? part.left : part.slides;
    report.allowed = is_loose ? part.allowed : part.may_slide;
  }
}

// What impacts change of velocities; see the class.
void Stepper::split_impacts(System& system, const State& now, const Stage& stage, double h) {
  std::vector<Vec3>& right_side = scratch_;
  std::ranges::fill(right_side, Vec3::Zero());
  const StepStart start{h, now.x, now.v, history_.h, history_.before.x, history_.before.v};
  if (!system.find_impacts({x_, v_, x_end_, 1 / stage.beta, stage.end_rate, past_}, start, right_side)) return;
  cg_.filter(right_side);
  cg_.prepare(system.linear_system(), solver::Sums::kept);
  goals_.clear();
  for (const PartState& part : parts_)
    goals_.push_back(numerics.newton.linear_fraction * part.allowed * std::sqrt(part.mass) / stage.beta);
  jumps_.resize(x_.size());
  cg_.solve(right_side, {parameters_.linear_tolerance, goals_}, parameters_.max_linear_iterations, jumps_,
            {.motion = v_});
  for_each_particle(x_.size(), [&](std::size_t i) { v_[i] += (1 - h / stage.beta) * jumps_[i]; });
}

// The end of the step from its stage.
void Stepper::finish(const State& now, const Stage& stage, std::span<const HeldParticle> held, State& next) const {
  for_each_particle(x_.size(), [&](std::size_t i) {
    next.x[i] = x_end_[i];
    next.v[i] = v_end(now, stage, i);
  });
  for (const HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    const Mat3& free = particle.constraint.free;
    next.x[i] = particle.x_end + free * (next.x[i] - particle.x_end);
    next.v[i] = particle.v_end + free * (next.v[i] - particle.v_end);
  }
}

// Velocity at the end of the step that the stage leads to.
Vec3 Stepper::v_end(const State& now, const Stage& stage, std::size_t i) const {
  return stage.end_rate == 1 ? v_[i] : Vec3(2 * v_[i] - now.v[i]);
}

// Of the step as it is at the current iterate; the formulas stand at the class.
void Stepper::estimate_local_errors(std::span<const double> masses, const State& now, const Stage& stage, double h) {
  const bool first_order = is_first_order(h);
  const double r = first_order ? 1 : h / history_.h;
  const bool bdf2 = method_ == Method::bdf2;
  const double of_gain = bdf2 ? 0.75 * h : 0.5 * h;
  const double of_change = bdf2 ? h * h * (1 + r) / (2 * (1 + 2 * r)) : h * h * r / (6 * (1 + r));
  for_each_particle(masses.size(), [&](std::size_t i) {
    const Vec3 gain = v_end(now, stage, i) - now.v[i];
    if (first_order)
      scratch_[i] = of_gain * gain;
    else
      scratch_[i] = of_change * (gain / h - (now.v[i] - history_.before.v[i]) / history_.h);
  });
  cg_.filter(scratch_);
  for (PartState& part : parts_) part.local_error = root_mean_square(part, masses, scratch_);
  if (method_ != Method::implicit_euler || history_.h == 0) return;
  for_each_particle(masses.size(), [&](std::size_t i) {
    scratch_[i] = 0.5 * (v_[i] - now.v[i] - h / history_.h * (now.v[i] - history_.before.v[i]));
  });
  cg_.filter(scratch_);
  for (PartState& part : parts_) part.velocity_error = root_mean_square(part, masses, scratch_);
}

Vec3 Stepper::constraint_force(Index particle, double mass) const {
  const auto i = static_cast<std::size_t>(particle);
  return mass / beta_ * (v_[i] - v_hat_[i]) - force_[i] - constant_force_[i];
}

// Whether a step over h is one of Euler's, or known no better.
bool Stepper::is_first_order(double h) const {
  return method_ == Method::implicit_euler || history_.h == 0 ||
         (method_ == Method::bdf2 && h > (1 + 1e-9) * kLargestRatio * history_.h);
}

double Stepper::longest_step() const {
  const bool bounded = method_ == Method::bdf2 && history_.h > 0;
  return bounded ? kLargestRatio * history_.h : std::numeric_limits<double>::infinity();
}

void Stepper::accept(const State& before, const State& after, double h) {
  history_.before.x.assign(before.x.begin(), before.x.begin() + std::ssize(before.v));
  history_.before.v = before.v;
  history_.h = h;
  if (method_ != Method::bdf2) return;
  for_each_particle(before.v.size(), [&](std::size_t i) {
    history_.before.v[i] += after.v[i] - solved_v_[i];
    if (!jumps_.empty()) history_.before.v[i] += jumps_[i];
  });
}

}  // namespace weft::integrator
