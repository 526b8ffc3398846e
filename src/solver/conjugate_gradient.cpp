#include "solver/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/numerics.hpp"
#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Stiffness of a particle against its entry of the metric (rate² m) up to which single precision will do: it rounds
// stiffness by a share of 6e-8. Sheets that swing on threads of 1e6, 1e7 and 1e8 N/m (shares of 8e5, 8e6 and 8e7) take
// as many iterations of Newton's method as in double: 361, 1,018 and 2,345 for 355, 1,126 and 2,932.
constexpr double kSingleStiffness = 1e7;

// Whether no particle is held more stiffly than that.
bool suits_single(const LinearSystem& system) {
  if (system.metric.empty()) return false;
  const auto fits = [&](Index particle, double stiffness) {
    return stiffness <= kSingleStiffness * system.metric[static_cast<std::size_t>(particle)];
  };
  const auto particle_fits = [&](Index i) {
    const double* block = system.matrix.values().data() + 9 * static_cast<std::size_t>(system.matrix.diagonal(i));
    return fits(i, block[0] + block[4] + block[8]);
  };
  const int misfits =
      parallel_sum(static_cast<std::size_t>(system.matrix.rows()), kGrainSize, [&](std::size_t begin, std::size_t end) {
        int any = 0;
        for (std::size_t i = begin; i < end; ++i) any |= particle_fits(static_cast<Index>(i)) ? 0 : 1;
        return any;
      });
  if (misfits > 0) return false;
  for (const DiagonalTerm& term : system.diagonal_terms)
    if (!fits(term.particle, term.stiffness.trace())) return false;
  bool all_fit = true;
  for_each_term(system, [&](const auto& term) {
    for (std::size_t k = 0; k < term.particles.size() && all_fit; ++k)
      all_fit = fits(term.particles[k], term.weights[k] * term.weights[k] * term.stiffness.trace());
  });
  return all_fit;
}

template <class Quad>
void copy_into(std::span<const Quad> from, std::vector<Vec3>& to) {
  to.resize(from.size());
  parallel_for(from.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] = vec3_of(from[i]);
  });
}

}  // namespace

void ConjugateGradient::filter(std::span<Vec3> b) const {
  for (const ParticleConstraint& c : system_->constraints) {
    Vec3& entry = b[static_cast<std::size_t>(c.particle)];
    entry = c.free * entry;
  }
}

template <class Real>
Recurrence<Real>& ConjugateGradient::prepared(InPrecision<Real>& in) {
  if (!in.is_prepared) in.recurrence.prepare(*system_, in.has_sums ? Sums::kept : Sums::anew);
  in.is_prepared = in.has_sums = true;
  return in.recurrence;
}

void ConjugateGradient::prepare(const LinearSystem& system, Sums sums) {
  system_ = &system;
  all_parts_.resize(parts_of(system).size());
  std::iota(all_parts_.begin(), all_parts_.end(), std::size_t{0});
  is_single_ = suits_single(system);
  single_.is_prepared = double_.is_prepared = false;
  if (sums == Sums::anew) single_.has_sums = double_.has_sums = false;
}

std::span<const Vec3> ConjugateGradient::precondition(std::span<const Vec3> b) {
  if (is_single_)
    copy_into(prepared(single_).precondition(b), preconditioned_);
  else
    copy_into(prepared(double_).precondition(b), preconditioned_);
  return preconditioned_;
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, const Directions& directions) {
  return solve(b, goal, max_iterations, x, directions, all_parts_);
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, const Directions& directions,
                                      std::span<const std::size_t> parts) {
  std::fill(x.begin(), x.end(), Vec3::Zero());
  Progress progress;
  progress.parts.resize(all_parts_.size());
  End end = End::needs_double;
  if (is_single_ && goal.relative >= kTightGoal) {
    end = prepared(single_).solve(b, goal, max_iterations, x, directions, parts, progress);
    filter(x);
    copy_into(single_.recurrence.residual(), residual_);
  }
  if (end == End::needs_double) {
    end = prepared(double_).solve(b, goal, max_iterations, x, directions, parts, progress);
    copy_into(double_.recurrence.residual(), residual_);
  }
  LinearReport report{progress.iterations, {}, end == End::converged, end != End::indefinite};
  // Where nothing is left nothing is to be estimated.
  for (const Progress::OfPart& part : progress.parts)
    report.errors.push_back(
        part.gains.empty() || progress.nothing_left ? 0 : std::sqrt(part.error_energy() * part.error_share()));
  return report;
}

}  // namespace weft::solver
