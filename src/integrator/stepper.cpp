#include "integrator/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::integrator {
namespace {

// Share of Newton's goal to which a linear system is solved at most, and share of its right hand side to which it is
// solved at least.
constexpr double kLinearShare = 0.3;
constexpr double kLeastLinear = 0.3;
// Share of the weight below which a change of velocity counts as none.
constexpr double kRest = 0.3;
// Slope behind the minimum, against that at the start, from which a step counts as overshooting.
constexpr double kOvershoot = 0.7;
constexpr int kLineTrials = 6;
// A part of the system (a cloth) is left alone while its residual is below this share of its share of the goal.
constexpr double kSolvedShare = 0.5;
// What Newton leaves is a wrong velocity, the same way in step after step: a force that is not there. Within this time
// [s] it may move the cloth by this share of the tolerance of one step. The time is that of a swing of cloth of a
// metre, in which the method's own errors of velocity do as much as those of position.
constexpr double kSwing = 0.3;
constexpr double kResidualShare = 0.1;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

std::string_view describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::solved:
      return "solved";
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
  for (auto* vector : {&x_hat_, &v_hat_, &x_, &v_, &x_end_, &constant_force_, &force_, &residual_, &delta_, &scale_})
    vector->resize(n);
  std::copy_n(now.x.begin(), n, x_hat_.begin());
  v_hat_ = now.v;
  if (method_ == Method::implicit_midpoint) return {0.5 * h, 2.0, 0.5};
  if (method_ == Method::implicit_euler || previous_h_ == 0) return {h, 1.0, 1.0};

  // BDF2 with variable steps; those who choose them keep to longest_step().
  const double r = h / previous_h_;
  const double now_weight = (1 + r) * (1 + r) / (1 + 2 * r), before_weight = r * r / (1 + 2 * r);
  for (std::size_t i = 0; i < n; ++i) {
    x_hat_[i] = now_weight * now.x[i] - before_weight * previous_.x[i];
    v_hat_[i] = now_weight * now.v[i] - before_weight * previous_.v[i];
  }
  return {h * (1 + r) / (1 + 2 * r), 1.0, 1.0};
}

// Brings v and x_end in line with x.
void Stepper::evaluate(const State& now, const Stage& stage) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    v_[i] = (x_[i] - x_hat_[i]) / stage.beta;
    x_end_[i] = now.x[i] + stage.end_rate * (x_[i] - now.x[i]);
  }
}

void Stepper::gather_residual(std::span<const double> masses, const Stage& stage) {
  for (std::size_t i = 0; i < x_.size(); ++i)
    residual_[i] = force_[i] + constant_force_[i] - (masses[i] / stage.beta) * (v_[i] - v_hat_[i]);
  cg_.filter(residual_);
}

// Norm of the residual at the current stage, with the preconditioner at hand.
double Stepper::residual(System& system, const State& now, const Stage& stage) {
  evaluate(now, stage);
  std::fill(force_.begin(), force_.end(), Vec3::Zero());
  system.forces({x_, v_, x_end_, 1 / stage.beta, stage.end_rate}, force_);
  gather_residual(system.masses(), stage);
  return cg_.norm(residual_);
}

// Norm of the weight of the particles, as far as residuals are measured against it.
double Stepper::weight(std::span<const double> masses, const Vec3& gravity) {
  const double least = std::max(gravity.norm(), 1.0);
  for (std::size_t i = 0; i < masses.size(); ++i) scale_[i] = Vec3(0, 0, masses[i] * least);
  cg_.filter(scale_);
  // Where all particles lie on a floor that holds them up, their weight is measured along it.
  if (!(dot(scale_, scale_) > 1e-12 * least * least * dot(masses, masses)))
    for (std::size_t i = 0; i < masses.size(); ++i) scale_[i] = Vec3::Constant(masses[i] * least);
  cg_.filter(scale_);
  return kRest * cg_.norm(scale_);
}

// Norm of what the residual is measured against: the weight, or the force that the change of velocity takes, whichever
// is more.
double Stepper::force_scale(std::span<const double> masses, double weight, const Stage& stage) {
  for (std::size_t i = 0; i < masses.size(); ++i) scale_[i] = masses[i] / stage.beta * (v_[i] - v_hat_[i]);
  cg_.filter(scale_);
  return std::max(weight, cg_.norm(scale_));
}

// Norm of a residual that still matters beside the tolerance of positions; infinite where there is none. In this norm
// the residual is the energy norm of the displacement δ that it stands for, and √(δᵀ M δ) / β is not more than that. δ
// leaves behind a velocity of δ / β: for that to move a part by a share of the tolerance within kSwing, δ itself must
// be smaller than that by h / kSwing. A share of the tolerance alone would not do: with steps h that follow the
// tolerance as h^(p+1), the force that is left, M δ / β², would shrink as h^(p-1) only, and cost the method an order.
double Stepper::residual_that_matters(std::span<const double> masses, double h, const Stage& stage,
                                      std::span<const solver::Part> parts) const {
  if (parameters_.position_tolerance == 0) return std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (const solver::Part& part : parts) {
    double mass = 0;
    for (auto i = static_cast<std::size_t>(part.begin); i < static_cast<std::size_t>(part.end); ++i) mass += masses[i];
    least = std::min(least, mass);
  }
  const double displacement = kResidualShare * parameters_.position_tolerance * (h / kSwing) / stage.end_rate;
  return displacement * std::sqrt(least) / stage.beta;
}

// Parts of the system whose residual is more than their share of the goal.
std::span<const std::size_t> Stepper::unsolved_parts(double goal) {
  const std::span<const double> norms_sq = cg_.part_norms_sq(residual_);
  const double share_sq = kSolvedShare * kSolvedShare * goal * goal / static_cast<double>(norms_sq.size());
  unsolved_.clear();
  for (std::size_t p = 0; p < norms_sq.size(); ++p)
    if (norms_sq[p] > share_sq) unsolved_.push_back(p);
  return unsolved_;
}

// Moves x along delta_: the whole way, or less where the whole way overshoots. Returns the norm of the residual there.
double Stepper::search_along_delta(System& system, const State& now, const Stage& stage) {
  // The residual is minus the gradient of the step's energy (where there is one), so residual · delta is the slope:
  // positive before the minimum along delta, negative behind. Where contacts or compressed edges switch on the way it
  // can turn steeply negative, and full steps would then go to and fro.
  const std::size_t n = x_.size();
  const double start_slope = dot(residual_, delta_);
  line_start_ = x_;
  double fraction = 1, low = 0, low_slope = start_slope, high = 0, high_slope = 0, norm = 0;
  for (int trial = 0; trial < kLineTrials; ++trial) {
    for (std::size_t i = 0; i < n; ++i) x_[i] = line_start_[i] + fraction * delta_[i];
    norm = residual(system, now, stage);
    const double slope = dot(residual_, delta_);
    if (!(slope < -kOvershoot * start_slope)) {
      if (high == 0 || slope <= kOvershoot * start_slope) break;
      low = fraction, low_slope = slope;
    } else {
      high = fraction, high_slope = slope;
    }
    // Regula falsi, kept away from the ends.
    const double guess = low + (high - low) * low_slope / (low_slope - high_slope);
    fraction = std::clamp(guess, low + 0.1 * (high - low), high - 0.1 * (high - low));
  }
  return norm;
}

// First guess: unchanged velocity. It is also where the non-stiff forces are taken, with the velocity extrapolated from
// the last step, so that they keep the method's order.
void Stepper::prepare_guess(const System& system, const State& now, const Stage& stage, double h, const Vec3& gravity) {
  const std::size_t n = now.v.size();
  const auto masses = system.masses();
  guess_.x.resize(n);
  guess_.v.resize(n);
  const double trend = previous_h_ > 0 && method_ != Method::implicit_euler ? stage.extrapolation * h / previous_h_ : 0;
  for (std::size_t i = 0; i < n; ++i) {
    x_[i] = now.x[i] + stage.extrapolation * h * now.v[i];
    guess_.x[i] = x_[i];
    guess_.v[i] = trend > 0 ? Vec3(now.v[i] + trend * (now.v[i] - previous_.v[i])) : now.v[i];
    constant_force_[i] = masses[i] * gravity;
  }
  system.explicit_forces(guess_, h, trend > 0, constant_force_);
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
                         std::span<const HeldParticle> held, State& next, Start start) {
  const std::size_t n = now.v.size();
  solver::LinearSystem& linear = system.linear_system();
  const auto masses = system.masses();
  const Stage stage = begin(now, h);
  beta_ = stage.beta;
  prepare_guess(system, now, stage, h, gravity);
  if (start == Start::next)
    for (std::size_t i = 0; i < n; ++i) x_[i] = now.x[i] + (next.x[i] - now.x[i]) / stage.end_rate;
  next.x.resize(now.x.size());
  next.v.resize(n);
  hold(now, stage, held, linear.constraints);

  StepReport report;
  const double matters = residual_that_matters(masses, h, stage, solver::parts_of(linear));
  for (;;) {
    evaluate(now, stage);
    std::fill(force_.begin(), force_.end(), Vec3::Zero());
    system.linearise({x_, v_, x_end_, 1 / stage.beta, stage.end_rate}, report.newton_iterations, force_);
    cg_.prepare(linear);
    gather_residual(masses, stage);
    const double before = cg_.norm(residual_), at_rest = weight(masses, gravity);
    const auto goal = [&] { return std::min(parameters_.tolerance * force_scale(masses, at_rest, stage), matters); };
    if (report.newton_iterations == 0) report.first_residual = before;
    const double target =
        std::min(std::max(parameters_.linear_tolerance * before, kLinearShare * goal()), kLeastLinear * before);
    // The first iteration is for all: cloth that creeps within the tolerance would never stop.
    const bool all = report.newton_iterations == 0 || unsolved_parts(goal()).empty();
    const solver::LinearReport solved =
        all ? cg_.solve(residual_, target, parameters_.max_linear_iterations, delta_)
            : cg_.solve(residual_, target, parameters_.max_linear_iterations, delta_, unsolved_);
    ++report.newton_iterations;
    report.linear_iterations += solved.iterations;

    report.last_residual = search_along_delta(system, now, stage);
    if (!std::isfinite(report.last_residual))
      report.verdict = Verdict::not_finite;
    else if (report.last_residual <= goal())
      break;
    else if (!solved.definite)
      report.verdict = Verdict::indefinite;
    else if (report.newton_iterations >= parameters_.max_iterations)
      report.verdict = Verdict::newton_stalled;
    if (report.verdict != Verdict::solved) return report;
  }

  for (std::size_t i = 0; i < n; ++i) {
    next.x[i] = x_end_[i];
    next.v[i] = stage.end_rate == 1 ? v_[i] : Vec3(2 * v_[i] - now.v[i]);
  }
  for (const HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    const Mat3& free = particle.constraint.free;
    next.x[i] = particle.x_end + free * (next.x[i] - particle.x_end);
    next.v[i] = particle.v_end + free * (next.v[i] - particle.v_end);
  }
  report.local_error = local_error(masses, now, next, h, solver::parts_of(linear));
  return report;
}

// Estimate of the local error of positions [m]; the formulas stand at the class.
double Stepper::local_error(std::span<const double> masses, const State& now, const State& next, double h,
                            std::span<const solver::Part> parts) {
  const bool first_order = method_ == Method::implicit_euler || previous_h_ == 0;
  const double r = first_order ? 1 : h / previous_h_;
  const bool bdf2 = method_ == Method::bdf2;
  const double of_gain = bdf2 ? 0.75 * h : 0.5 * h;
  const double of_change = bdf2 ? h * h * (1 + r) / (2 * (1 + 2 * r)) : h * h * r / (6 * (1 + r));
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vec3 gain = next.v[i] - now.v[i];
    if (first_order)
      scale_[i] = of_gain * gain;
    else
      scale_[i] = of_change * (gain / h - (now.v[i] - previous_.v[i]) / previous_h_);
  }
  cg_.filter(scale_);
  double largest_sq = 0;
  for (const solver::Part& part : parts) {
    double mass = 0, sum = 0;
    for (auto i = static_cast<std::size_t>(part.begin); i < static_cast<std::size_t>(part.end); ++i) {
      mass += masses[i];
      sum += masses[i] * scale_[i].squaredNorm();
    }
    largest_sq = std::max(largest_sq, sum / mass);
  }
  return std::sqrt(largest_sq);
}

Vec3 Stepper::constraint_force(Index particle, double mass) const {
  const auto i = static_cast<std::size_t>(particle);
  return mass / beta_ * (v_[i] - v_hat_[i]) - force_[i] - constant_force_[i];
}

double Stepper::longest_step() const {
  const bool bounded = method_ == Method::bdf2 && previous_h_ > 0;
  return bounded ? kLargestRatio * previous_h_ : std::numeric_limits<double>::infinity();
}

void Stepper::accept(const State& before, double h) {
  if (method_ == Method::implicit_euler) return;
  previous_.x.assign(before.x.begin(), before.x.begin() + std::ssize(before.v));
  previous_.v = before.v;
  previous_h_ = h;
}

}  // namespace weft::integrator
