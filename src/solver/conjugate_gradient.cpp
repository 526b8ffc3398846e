#include "solver/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Rows per chunk: some 100 µs of work. With 1024, handing chunks to a second thread cost a tenth of the run on systems
// of 3,000 particles.
constexpr std::size_t kChunk = 4096;

// To make the factor costs as much as some 35 iterations without it, and an iteration with it as much as 2.2 to 2.6.
// What it gains, iterations by 1.4 (crumpled cloth of 6·10⁴ particles) to over 100 (taut threads of 1e6 N/m), shows
// only after long: threads seem to converge at first. So a target below this share of the right hand side takes it at
// once;
constexpr double kTightTarget = 1e-3;
// any other when, at the rate of the last kPaceInterval iterations, more than kMinIterationsLeft are still to come.
// Scenes ask for 0.1 and need ten in all.
constexpr int kPaceInterval = 40;
constexpr double kMinIterationsLeft = 100;
// Weight of the factor beside the levels: both are right about long waves, and with equal weights these count twice,
// which took twice the iterations of the factor alone on plain folds; with 16 as many. On crumpled stiff sheets both
// together need about half of what the factor needs alone.
constexpr double kFactorWeight = 16;

// Whether a residual that fell from `before` to `now` in kPaceInterval iterations needs more than kMinIterationsLeft
// to reach the target.
bool factor_pays(double before, double now, double target) {
  return !(std::log(now / target) * kPaceInterval < kMinIterationsLeft * std::log(before / now));
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

}  // namespace

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

// z += kFactorWeight (L Lᵀ)⁻¹ r_; returns what that adds to r_·z.
double ConjugateGradient::add_factor(std::span<Vec3> z, std::span<const std::size_t> parts) {
  factor_parts_.clear();
  for (std::size_t p : parts) factor_parts_.push_back(parts_[p]);
  const double sum = factor_.add(kFactorWeight, r_, z, factor_parts_);
  filter(z);
  return sum;
}

double ConjugateGradient::norm(std::span<const Vec3> b) {
  return std::sqrt(preconditioner_.apply(b, z_, all_parts_));
}

std::span<const double> ConjugateGradient::part_norms_sq(std::span<const Vec3> b) {
  preconditioner_.apply(b, z_, all_parts_);
  part_norms_sq_.clear();
  for (const Part& part : parts_) part_norms_sq_.push_back(dot(part, b, z_));
  return part_norms_sq_;
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
  for (const DiagonalTerm& term : system_->diagonal_terms)
    q[static_cast<std::size_t>(term.particle)] += term.stiffness * p[static_cast<std::size_t>(term.particle)];
  for (const StencilTerm* term : terms_) {
    const auto& [a, b, c, d] = term->particles;
    const auto& w = term->weights;
    const Vec3 force =
        term->stiffness * (w[0] * p[static_cast<std::size_t>(a)] + w[1] * p[static_cast<std::size_t>(b)] +
                           w[2] * p[static_cast<std::size_t>(c)] + w[3] * p[static_cast<std::size_t>(d)]);
    for (int k = 0; k < 4; ++k) q[static_cast<std::size_t>(term->particles[k])] += w[k] * force;
  }
  filter(q);
  double sum = 0;
  for (std::size_t part : parts) sum += dot(parts_[part], p, q);
  return sum;
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x) {
  return solve(b, target, max_iterations, x, all_parts_);
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x,
                                      std::span<const std::size_t> parts) {
  LinearReport report;
  std::fill(x.begin(), x.end(), Vec3::Zero());
  std::fill(p_.begin(), p_.end(), Vec3::Zero());
  std::fill(q_.begin(), q_.end(), Vec3::Zero());
  std::copy(b.begin(), b.end(), r_.begin());
  filter(r_);
  select_terms(parts);
  double rz = preconditioner_.apply(r_, p_, parts);
  report.first_residual = report.last_residual = std::sqrt(rz);
  double paced_from = report.first_residual;
  bool with_factor = target < kTightTarget * report.first_residual && make_factor();
  if (with_factor) rz += add_factor(p_, parts);

  while (!(report.last_residual <= target) && report.iterations < max_iterations) {
    const double curvature = multiply(p_, q_, parts);
    if (!(curvature > 0)) {
      report.definite = false;
      return report;
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
    double rz_next = preconditioner_.apply(r_, z_, parts);
    report.last_residual = std::sqrt(rz_next);
    ++report.iterations;
    // Directions made without the factor say nothing about those with it.
    bool restart = false;
    if (!with_factor && report.iterations % kPaceInterval == 0) {
      restart = with_factor = factor_pays(paced_from, report.last_residual, target) && make_factor();
      paced_from = report.last_residual;
    }
    if (with_factor) rz_next += add_factor(z_, parts);
    const double beta = restart ? 0 : rz_next / rz;
    for (std::size_t part : parts) {
      for_rows(parts_[part], [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
      });
    }
    rz = rz_next;
  }
  report.converged = report.last_residual <= target;
  return report;
}

}  // namespace weft::solver
