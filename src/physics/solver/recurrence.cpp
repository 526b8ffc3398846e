#include "physics/solver/recurrence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "core/numerics.hpp"
#include "core/stop.hpp"

namespace weft::solver {
namespace {

double absolute_goal(const LinearGoal& goal, std::size_t block_index) {
  return goal.absolute.empty() ? 0 : goal.absolute[block_index];
}

template <class Real>
void convert_to_padded(std::span<const Vec3> from, std::span<PaddedVec3<Real>> to) {
  parallel_for(from.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] = padded<Real>(from[i]);
  });
}

}  // namespace

// Sums absolute values: contact terms and the coarsest level couple diagonal blocks, so the gain of
// a single diagonal block may be negative.
double Progress::BlockProgress::error_energy() const {
  return std::accumulate(gains.end() - count_recent(), gains.end(), 0.0,
                         [](double sum, double gain) { return sum + std::abs(gain); });
}

double Progress::BlockProgress::error_norm_ratio() const {
  return *std::max_element(norm_ratios.end() - count_recent(), norm_ratios.end());
}

// Number of last iterations from which the error is estimated.
std::ptrdiff_t Progress::BlockProgress::count_recent() const {
  const std::ptrdiff_t all = std::ssize(gains);
  return std::min<std::ptrdiff_t>(
      all, std::max<std::ptrdiff_t>(numerics.linear.min_error_window, all / numerics.linear.error_window_divisor));
}

bool Progress::meets(const LinearGoal& goal, std::span<const std::size_t> selected) const {
  return std::ranges::all_of(selected, [&](std::size_t p) {
    const double error_sq = blocks[p].error_energy(), absolute = absolute_goal(goal, p);
    return error_sq <= goal.relative * goal.relative * blocks[p].energy ||
           error_sq * blocks[p].error_norm_ratio() <= absolute * absolute;
  });
}

// If the step along `start` is the solution, only rounding remains in the residual r: in single
// precision, r·z (z = P⁻¹ r) is then at most this fraction of the energy that the step gains.
// Iterations on such a residual would add uneven motion, of micrometres in a fall of 5 m.
constexpr double kRoundedEnergy = 1e-11;

template <class Real>
void Recurrence<Real>::prepare(const LinearSystem& system, AggregateSums sums) {
  system_ = &system;
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  for (auto* vector : {&x_, &r_, &z_, &p_, &q_})
    if (vector->size() != rows) vector->assign(rows, PaddedVec3<Real>{});
  blocks_ = blocks_of(system);
  product_.prepare(system);
  preconditioner_.prepare(system, sums);
  rank_one_.prepare(system);
}

template <class Real>
std::span<const PaddedVec3<Real>> Recurrence<Real>::precondition(std::span<const Vec3> b,
                                                                 std::span<const std::size_t> all_blocks) {
  convert_to_padded<Real>(b, q_);
  selected_.assign(all_blocks.begin(), all_blocks.end());
  rank_one_.select(selected_);
  precondition_rank_one();
  preconditioner_.apply(q_, z_, selected_);
  rank_one_.correct(z_);
  return z_;
}

// Prepares rank_one_ for the preconditioner on the selected blocks.
template <class Real>
void Recurrence<Real>::precondition_rank_one() {
  rank_one_.prepare_inverses([&](std::span<const PaddedVec3<Real>> r, std::span<PaddedVec3<Real>> z) {
    preconditioner_.apply(r, z, selected_);
  });
}

// a·b of each selected block
template <class Real>
std::vector<double> Recurrence<Real>::dots(std::span<const PaddedVec3<Real>> a,
                                           std::span<const PaddedVec3<Real>> b) const {
  std::vector<double> result;
  for (const PaddedVec3<double>&of_block : rows_.sums([&](std::size_t first, std::size_t end) {
         PaddedVec3<double> of_chunk{};
         for (std::size_t i = first; i < end; ++i) of_chunk += products(a[i], b[i]);
         return of_chunk;
       }))
    result.push_back(sum_of_first_three(of_block));
  return result;
}

// z = P⁻¹ r; returns r·z.
template <class Real>
double Recurrence<Real>::apply_preconditioner(std::span<PaddedVec3<Real>> z) {
  preconditioner_.apply(r_, z, selected_);
  rank_one_.correct(z);
  rz_ = dots(r_, z);
  return std::accumulate(rz_.begin(), rz_.end(), 0.0);
}

// Sets r_ to b − A x, and x_, the sum of the following steps, to zero. If the solve has no iterations yet, also takes
// the step along `start`.
template <class Real>
void Recurrence<Real>::begin(std::span<const Vec3> b, std::span<const Vec3> x, std::span<const Vec3> start,
                             Progress& progress) {
  start_multiple_ = start_gain_ = 0;
  product_.select(selected_);
  rank_one_.select(selected_);
  norms_sq_.resize(selected_.size());
  rz_.resize(selected_.size());
  // Terms read z_ and p_ outside of the selected blocks, too: precondition() has left values there.
  for (auto* vector : {&x_, &z_, &p_, &q_}) std::fill(vector->begin(), vector->end(), PaddedVec3<Real>{});
  convert_to_padded<Real>(b, r_);
  product_.filter(r_);
  if (progress.iterations > 0) {
    convert_to_padded<Real>(x, p_);
    multiply();
    rows_.for_each([&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) r_[i] -= q_[i];
    });
  } else if (!start.empty()) {
    step_along_start(start);
  }
}

// Takes the step along `start`, if the matrix has positive curvature along it. Stores the step in
// double outside of x_, as start_multiple_ times start_.
template <class Real>
void Recurrence<Real>::step_along_start(std::span<const Vec3> start) {
  start_.assign(start.begin(), start.end());
  for (const ParticleConstraint& c : system_->constraints)
    start_[static_cast<std::size_t>(c.particle)] = c.free * start_[static_cast<std::size_t>(c.particle)];
  rows_.for_each([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) p_[i] = padded<Real>(start_[i]);
  });
  const double curvature = multiply();
  if (!(curvature > 0)) return;
  const std::vector<double> slopes = dots(p_, r_);
  const double slope = std::accumulate(slopes.begin(), slopes.end(), 0.0);
  start_multiple_ = slope / curvature;
  start_gain_ = start_multiple_ * slope;
  const Real alpha = static_cast<Real>(start_multiple_);
  rows_.for_each([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) r_[i] -= alpha * q_[i];
  });
}

// Takes a step of length alpha along p_, and records the gain of each diagonal block.
template <class Real>
void Recurrence<Real>::advance(double alpha, Progress& progress) {
  const Real step = static_cast<Real>(alpha);
  rows_.for_each([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      x_[i] += step * p_[i];
      r_[i] -= step * q_[i];
    }
  });
  for (std::size_t k = 0; k < selected_.size(); ++k) {
    Progress::BlockProgress& block = progress.blocks[selected_[k]];
    const double gain = alpha * rz_[k];
    const bool has_norm = !system_->norm_weights.empty() && gain > 0;
    block.gains.push_back(gain);
    block.norm_ratios.push_back(has_norm ? std::min(1.0, alpha * alpha * norms_sq_[k] / gain) : 1);
    block.energy += gain;
  }
  ++progress.iterations;
}

template <class Real>
End Recurrence<Real>::iterate(const LinearGoal& goal, int max_iterations, Progress& progress) {
  constexpr bool kSingle = std::is_same_v<Real, float>;
  precondition_rank_one();
  double rz = apply_preconditioner(p_);
  progress.is_exact = rz <= (kSingle ? kRoundedEnergy * start_gain_ : 0);
  if (progress.is_exact) return End::converged;
  while (progress.iterations < max_iterations) {
    end_if_stopped();
    const double curvature = multiply();
    if (!(curvature > 0)) return kSingle ? End::needs_double : End::indefinite;
    advance(rz / curvature, progress);
    if (progress.meets(goal, selected_)) return End::converged;
    const double rz_before = std::exchange(rz, apply_preconditioner(z_));
    progress.is_exact = rz == 0;
    if (progress.is_exact) return End::converged;
    const Real beta = static_cast<Real>(rz / rz_before);
    rows_.for_each([&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
    });
  }
  return End::out_of_iterations;
}

// The work of forces v along the directions of each selected block: the translations, p_ and, if
// `has_second`, z_.
template <class Real>
std::vector<AlongMotions> Recurrence<Real>::along_motions(std::span<const PaddedVec3<Real>> v, bool has_second) const {
  const std::vector<double> first = dots(p_, v),
                            second = has_second ? dots(z_, v) : std::vector<double>(selected_.size(), 0);
  const auto sums = rows_.sums([&](std::size_t begin, std::size_t end) {
    PaddedVec3<double> of_chunk{};
    for (std::size_t i = begin; i < end; ++i) of_chunk += __builtin_convertvector(v[i], PaddedVec3<double>);
    return of_chunk;
  });
  std::vector<AlongMotions> result(selected_.size());
  for (std::size_t k = 0; k < selected_.size(); ++k) result[k] << vec3_of(sums[k]), first[k], second[k];
  return result;
}

// Galerkin's condition: makes the residual orthogonal to the translations and motions of each diagonal block. Without
// this correction, residual forces in stiff directions do work: cloth with a viscosity of 1e3 N·s/m gains energy, and
// cloth that begins to slide is held back.
template <class Real>
void Recurrence<Real>::balance(const Directions& directions, std::span<Vec3> x) {
  const bool has_second = !directions.drift.empty();
  rows_.for_each([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) p_[i] = padded<Real>(Vec3(directions.motion[i] + x[i]));
    if (!has_second) return;
    for (std::size_t i = first; i < end; ++i) z_[i] = padded<Real>(directions.drift[i]);
  });
  product_.filter(p_);
  std::vector<BlockMotions::Products> products(selected_.size(), BlockMotions::Products::Zero());
  const auto store_products = [&](int motion) {
    const std::vector<AlongMotions> along = along_motions(q_, has_second);
    for (std::size_t k = 0; k < selected_.size(); ++k) products[k].col(motion) = along[k];
  };
  multiply();
  store_products(0);
  if (has_second) {
    product_.filter(z_);
    std::swap(p_, z_);
    multiply();
    std::swap(p_, z_);
    store_products(1);
  }
  block_motions_.prepare<Real>(*system_, selected_, {p_, has_second ? z_ : std::span<const PaddedVec3<Real>>()},
                               product_.row_sums(), products);
  const std::vector<AlongMotions> change = block_motions_.solve(along_motions(r_, has_second));
  for (std::size_t k = 0; k < selected_.size(); ++k) {
    const auto first = static_cast<std::size_t>(blocks_[selected_[k]].begin);
    const PaddedVec3<Real> shift = padded<Real>(Vec3(change[k].template head<3>()));
    const Real of_motion = static_cast<Real>(change[k][3]), of_drift = static_cast<Real>(change[k][4]);
    parallel_for(static_cast<std::size_t>(blocks_[selected_[k]].end) - first, kGrainSize,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = first + begin; i < first + end; ++i) p_[i] = of_motion * p_[i] + shift;
                   if (!has_second) return;
                   for (std::size_t i = first + begin; i < first + end; ++i) p_[i] += of_drift * z_[i];
                 });
  }
  multiply();
  rows_.for_each([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      x[i] += vec3_of(p_[i]);
      r_[i] -= q_[i];
    }
  });
}

template <class Real>
End Recurrence<Real>::solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
                            const Directions& directions, std::span<const std::size_t> blocks, Progress& progress) {
  selected_.assign(blocks.begin(), blocks.end());
  rows_ = RowChunks(ranges_of(blocks_, selected_), kGrainSize);
  begin(b, x, directions.start, progress);
  const End end = iterate(goal, max_iterations, progress);
  if (end == End::needs_double && progress.iterations == 0) return end;  // the solve starts anew in double
  rows_.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) x[i] += vec3_of(x_[i]);
    if (start_multiple_ == 0) return;
    for (std::size_t i = first; i < last; ++i) x[i] += start_multiple_ * start_[i];
  });
  const bool is_end = end == End::converged || end == End::out_of_iterations;
  if (is_end && progress.iterations > 0 && !directions.motion.empty()) balance(directions, x);
  return end;
}

template class Recurrence<float>;
template class Recurrence<double>;

}  // namespace weft::solver
