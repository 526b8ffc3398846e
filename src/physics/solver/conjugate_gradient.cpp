#include "physics/solver/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::solver {
namespace {

// Maximum stiffness of a particle (trace of its 3×3 block) for single precision, relative to its norm weight rate² m.
// Single precision rounds stiffness by 6e-8. (Measured: swinging sheets whose threads have ratios of 8e5, 8e6 and 8e7
// take 361, 1,018 and 2,345 Newton iterations; in double 355, 1,126 and 2,932.)
constexpr double kMaxSingleStiffness = 1e7;

// If more than this number of successive prepare() calls with AggregateSums::recompute have not
// used a precision, ConjugateGradient frees its memory. To allocate the memory again takes the time
// of a few iterations. (Measured: if cloth is pulled through a ring, 40 of 356 iterations, in 95
// solves, use double precision.)
constexpr int kSolvesUnused = 16;

// Whether no particle exceeds kMaxSingleStiffness. False without a mass-weighted norm.
bool allows_single_precision(const LinearSystem& system) {
  if (system.norm_weights.empty()) return false;
  const auto fits = [&](Index particle, double stiffness) {
    return stiffness <= kMaxSingleStiffness * system.norm_weights[static_cast<std::size_t>(particle)];
  };
  if (!parallel_all_of(at(system.matrix.rows()), [&](std::size_t i) {
        return fits(static_cast<Index>(i), system.matrix.trace(static_cast<Index>(i)));
      }))
    return false;
  for (const DiagonalTerm& term : system.diagonal_terms)
    if (!fits(term.particle, term.stiffness.trace())) return false;
  bool all_fit = true;
  for_each_term(system, [&](const auto& term) {
    for (std::size_t k = 0; k < term.particles.size() && all_fit; ++k)
      all_fit = fits(term.particles[k], term.weights[k] * term.weights[k] * term.stiffness.trace());
  });
  return all_fit;
}

template <class Padded>
void copy_as_vec3(std::span<const Padded> from, std::vector<Vec3>& to) {
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
void ConjugateGradient::PrecisionState<Real>::begin_sums() {
  unused = has_aggregate_sums ? 0 : unused + 1;
  if (unused > kSolvesUnused) recurrence.reset();
  has_aggregate_sums = false;
}

template <class Real>
Recurrence<Real>& ConjugateGradient::prepare_recurrence(PrecisionState<Real>& in) {
  if (!in.recurrence) in.recurrence.emplace();
  if (!in.is_prepared)
    in.recurrence->prepare(*system_, in.has_aggregate_sums ? AggregateSums::reuse : AggregateSums::recompute);
  in.is_prepared = in.has_aggregate_sums = true;
  return *in.recurrence;
}

void ConjugateGradient::prepare(const LinearSystem& system, AggregateSums sums) {
  system_ = &system;
  all_blocks_.resize(blocks_of(system).size());
  std::iota(all_blocks_.begin(), all_blocks_.end(), std::size_t{0});
  allows_single_ = allows_single_precision(system);
  single_.is_prepared = double_.is_prepared = false;
  if (sums == AggregateSums::reuse) return;
  single_.begin_sums();
  double_.begin_sums();
}

std::span<const Vec3> ConjugateGradient::precondition(std::span<const Vec3> b) {
  if (allows_single_)
    copy_as_vec3(prepare_recurrence(single_).precondition(b, all_blocks_), preconditioned_);
  else
    copy_as_vec3(prepare_recurrence(double_).precondition(b, all_blocks_), preconditioned_);
  return preconditioned_;
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, const Directions& directions) {
  return solve(b, goal, max_iterations, x, directions, all_blocks_);
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations,
                                      std::span<Vec3> x, const Directions& directions,
                                      std::span<const std::size_t> blocks) {
  std::fill(x.begin(), x.end(), Vec3::Zero());
  Progress progress;
  progress.blocks.resize(all_blocks_.size());
  End end = End::needs_double;
  if (allows_single_ && goal.relative >= kSmallestSingleGoal) {
    end = prepare_recurrence(single_).solve(b, goal, max_iterations, x, directions, blocks, progress);
    filter(x);
    copy_as_vec3(single_.recurrence->residual(), residual_);
  }
  if (end == End::needs_double) {
    end = prepare_recurrence(double_).solve(b, goal, max_iterations, x, directions, blocks, progress);
    copy_as_vec3(double_.recurrence->residual(), residual_);
  }
  LinearReport report{progress.iterations, {}, end == End::converged, end != End::indefinite};
  // Without iterations, or if only rounding remains in the residual, the error counts as zero.
  for (const Progress::BlockProgress& block : progress.blocks)
    report.errors.push_back(
        block.gains.empty() || progress.is_exact ? 0 : std::sqrt(block.error_energy() * block.error_norm_ratio()));
  return report;
}

}  // namespace weft::solver
