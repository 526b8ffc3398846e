#include "solver/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Rows per chunk: some 100 µs of work. With 1024, handing chunks to a second thread cost a tenth of the run on systems
// of 3,000 particles.
constexpr std::size_t kChunk = 4096;

// To make the factor costs as much as some 35 iterations without it, and an iteration with it as much as 2.2 to 2.6.
// What it gains, iterations by 1.4 (crumpled cloth of 6·10⁴ particles) to over 100 (taut threads of 1e6 N/m), shows
// only after long: threads seem to converge at first. So a goal that is this share of the solution, and nothing else,
// takes it at once;
constexpr double kTightTarget = 1e-3;
// any other when, at the rate of the last kPaceInterval iterations, more than kMinIterationsLeft are still to come.
// Scenes ask for 0.1 and need ten in all.
constexpr int kPaceInterval = 40;
constexpr double kMinIterationsLeft = 100;
// Weight of the factor beside the levels: both are right about long waves, and with equal weights these count twice,
// which took twice the iterations of the factor alone on plain folds; with 16 as many. On crumpled stiff sheets both
// together need about half of what the factor needs alone.
constexpr double kFactorWeight = 16;

// Iterations whose gains are the estimate of the error: so many at least, of all of them a share of one over this, for
// long solves have plateaus.
constexpr std::size_t kLeastDelay = 3, kDelayShare = 5;
// Least share of the energy norm that must be solved before the metric alone may end a solve: stiff motion comes first,
// and shows nothing in it.
constexpr double kSolvedInEnergy = 0.3;

// Whether an error that fell from `before` to `now` times what it may be, in kPaceInterval iterations, needs more than
// kMinIterationsLeft to get there.
bool factor_pays(double before, double now) {
  return !(std::log(now) * kPaceInterval < kMinIterationsLeft * std::log(before / now));
}

// Calls body(begin, end) for chunks of the rows of a part.
template <class Body>
void for_rows(const Part& part, const Body& body) {
  const auto first = static_cast<std::size_t>(part.begin), count = static_cast<std::size_t>(part.end) - first;
  parallel_for(count, kChunk, [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
}

double dot(const Part& part, std::span<const Vec3> a, std::span<const Vec3> b) {
  const auto first = static_cast<std::size_t>(part.begin), count = static_cast<std::size_t>(part.end) - first;
  return parallel_sum(count, kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = first + begin; i < first + end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

// Σ weights ‖p‖² over the rows of a part.
double weighed_square(const Part& part, std::span<const double> weights, std::span<const Vec3> p) {
  const auto first = static_cast<std::size_t>(part.begin), count = static_cast<std::size_t>(part.end) - first;
  return parallel_sum(count, kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = first + begin; i < first + end; ++i) sum += weights[i] * p[i].squaredNorm();
    return sum;
  });
}

}  // namespace

double ConjugateGradient::PartState::error_energy() const {
  return std::accumulate(gains.end() - recent(), gains.end(), 0.0);
}

double ConjugateGradient::PartState::error_share() const {
  return *std::max_element(shares.end() - recent(), shares.end());
}

// How many of the last iterations tell the error.
std::ptrdiff_t ConjugateGradient::PartState::recent() const {
  return static_cast<std::ptrdiff_t>(std::min(gains.size(), std::max(kLeastDelay, gains.size() / kDelayShare)));
}

void ConjugateGradient::prepare(const LinearSystem& system) {
  system_ = &system;
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  for (auto* vector : {&r_, &z_, &p_, &q_})
    if (vector->size() != rows) vector->assign(rows, Vec3::Zero());
  parts_ = parts_of(system);
  all_parts_.resize(parts_.size());
  std::iota(all_parts_.begin(), all_parts_.end(), std::size_t{0});
  preconditioner_.prepare(system);
  factor_state_ = Factor::not_made;
}

// Whether there is a factor of the system as prepared.
bool ConjugateGradient::make_factor() {
  if (factor_state_ == Factor::not_made) factor_state_ = factor_.factorise(*system_) ? Factor::made : Factor::none;
  return factor_state_ == Factor::made;
}

// z = P⁻¹ r_, with or without the factor; returns r·z.
double ConjugateGradient::apply_preconditioner(std::span<Vec3> z, bool with_factor,
                                               std::span<const std::size_t> parts) {
  preconditioner_.apply(r_, z, parts);
  if (with_factor) {
    factor_parts_.clear();
    for (std::size_t p : parts) factor_parts_.push_back(parts_[p]);
    factor_.add(kFactorWeight, r_, z, factor_parts_);
    filter(z);
  }
  double sum = 0;
  for (std::size_t p : parts) sum += part_rz_[p] = dot(parts_[p], r_, z);
  return sum;
}

std::span<const Vec3> ConjugateGradient::precondition(std::span<const Vec3> b) {
  preconditioner_.apply(b, z_, all_parts_);
  return z_;
}

void ConjugateGradient::select_terms(std::span<const std::size_t> parts) {
  terms_.clear();
  const auto inside = [&](Index particle) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](std::size_t p) { return particle >= parts_[p].begin && particle < parts_[p].end; });
  };
  for (const StencilTerm& term : system_->terms) {
    bool acts = parts.size() == parts_.size();
    for (int k = 0; k < 4 && !acts; ++k) acts = term.weights[k] != 0 && inside(term.particles[k]);
    if (acts) terms_.push_back(&term);
  }
}

// q = S A p on the rows of these parts, p being zero on the others; returns p·q. p obeys the constraints, so
// p·q = pᵀ A p.
double ConjugateGradient::multiply(std::span<const Vec3> p, std::span<Vec3> q,
                                   std::span<const std::size_t> parts) const {
  for (std::size_t part : parts)
    for_rows(parts_[part], [&](std::size_t begin, std::size_t end) { system_->matrix.multiply(p, q, begin, end); });
  for (const DiagonalTerm& term : system_->diagonal_terms) q[term.particle] += term.stiffness * p[term.particle];
  for (const StencilTerm* term : terms_) {
    const auto& [a, b, c, d] = term->particles;
    const auto& w = term->weights;
    const Vec3 force = term->stiffness * (w[0] * p[a] + w[1] * p[b] + w[2] * p[c] + w[3] * p[d]);
    for (int k = 0; k < 4; ++k) q[term->particles[k]] += w[k] * force;
  }
  filter(q);
  double sum = 0;
  for (std::size_t part : parts) sum += dot(parts_[part], p, q);
  return sum;
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, std::span<const Vec3> start) {
  return solve(b, goal, max_iterations, x, start, all_parts_);
}

// r_ and x before the first iteration.
void ConjugateGradient::begin(std::span<const Vec3> b, std::span<const Vec3> start, std::span<Vec3> x,
                              std::span<const std::size_t> parts) {
  std::fill(x.begin(), x.end(), Vec3::Zero());
  std::fill(p_.begin(), p_.end(), Vec3::Zero());
  std::fill(q_.begin(), q_.end(), Vec3::Zero());
  std::copy(b.begin(), b.end(), r_.begin());
  filter(r_);
  select_terms(parts);
  part_rz_.assign(parts_.size(), 0);
  states_.assign(parts_.size(), {});
  if (!start.empty()) begin_along(start, x, parts);
}

// A step along `start`.
void ConjugateGradient::begin_along(std::span<const Vec3> start, std::span<Vec3> x,
                                    std::span<const std::size_t> parts) {
  for (std::size_t part : parts)
    std::copy(start.begin() + parts_[part].begin, start.begin() + parts_[part].end, p_.begin() + parts_[part].begin);
  filter(p_);
  const double curvature = multiply(p_, q_, parts);
  if (!(curvature > 0)) return;
  double slope = 0;
  for (std::size_t part : parts) slope += dot(parts_[part], p_, r_);
  const double alpha = slope / curvature;
  for (std::size_t part : parts) {
    for (auto i = parts_[part].begin; i < parts_[part].end; ++i) {
      x[i] = alpha * p_[i];
      r_[i] -= alpha * q_[i];
    }
  }
}

// What an iteration over `alpha` along p_ has gained.
void ConjugateGradient::note_gains(double alpha, std::span<const std::size_t> parts) {
  for (std::size_t part : parts) {
    PartState& state = states_[part];
    const double gain = alpha * part_rz_[part];
    double share = 1;
    if (!system_->metric.empty() && gain > 0) {
      const double moved = alpha * alpha * weighed_square(parts_[part], system_->metric, p_);
      share = std::min(1.0, moved / gain);
    }
    state.gains.push_back(gain);
    state.shares.push_back(share);
    state.energy += gain;
  }
}

bool ConjugateGradient::meets(const LinearGoal& goal, std::span<const std::size_t> parts) const {
  return std::ranges::all_of(parts, [&](std::size_t part) {
    const PartState& state = states_[part];
    const double error_sq = state.error_energy();
    const double absolute = goal.absolute.empty() ? 0 : goal.absolute[part];
    return error_sq <= std::max(absolute * absolute, goal.relative * goal.relative * state.energy) ||
           (error_sq * state.error_share() <= absolute * absolute &&
            error_sq <= kSolvedInEnergy * kSolvedInEnergy * state.energy);
  });
}

// The largest error of all parts, in shares of what it may be: the square of it in the energy norm.
double ConjugateGradient::farthest_from(const LinearGoal& goal, std::span<const std::size_t> parts) const {
  double farthest = 0;
  for (std::size_t part : parts) {
    const double absolute = goal.absolute.empty() ? 0 : goal.absolute[part];
    const double allowed = std::max(absolute, goal.relative * std::sqrt(states_[part].energy));
    farthest = std::max(farthest, std::sqrt(states_[part].error_energy()) / allowed);
  }
  return farthest;
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, std::span<const Vec3> start,
                                      std::span<const std::size_t> parts) {
  LinearReport report;
  begin(b, start, x, parts);
  bool with_factor = goal.relative < kTightTarget && goal.absolute.empty() && make_factor();
  double rz = apply_preconditioner(p_, with_factor, parts);
  double paced_from = 0;
  report.converged = rz == 0;
  while (!report.converged && report.iterations < max_iterations) {
    const double curvature = multiply(p_, q_, parts);
    if (!(curvature > 0)) {
      report.definite = false;
      break;
    }
    const double alpha = rz / curvature;
    for (std::size_t part : parts) {
      for_rows(parts_[part], [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          x[i] += alpha * p_[i];
          r_[i] -= alpha * q_[i];
        }
      });
    }
    note_gains(alpha, parts);
    ++report.iterations;
    if ((report.converged = meets(goal, parts))) break;
    // Directions made without the factor say nothing about those with it.
    bool restart = false;
    if (report.iterations == 1) paced_from = farthest_from(goal, parts);
    if (!with_factor && report.iterations % kPaceInterval == 0) {
      const double far = farthest_from(goal, parts);
      restart = with_factor = factor_pays(paced_from, far) && make_factor();
      paced_from = far;
    }
    const double rz_before = std::exchange(rz, apply_preconditioner(z_, with_factor, parts));
    if ((report.converged = rz == 0)) break;
    const double beta = restart ? 0 : rz / rz_before;
    for (std::size_t part : parts) {
      for_rows(parts_[part], [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
      });
    }
  }
  // Where nothing is left nothing is to be estimated.
  for (const PartState& state : states_)
    report.errors.push_back(state.gains.empty() || rz == 0 ? 0 : std::sqrt(state.error_energy() * state.error_share()));
  return report;
}

}  // namespace weft::solver
