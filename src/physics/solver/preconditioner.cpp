#include "physics/solver/preconditioner.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::solver {
namespace {

// The block of an aggregate may be singular up to rounding. A shift by this fraction of the block's trace makes it
// definite. The fraction must be below the ratio of mass part to thread stiffness (measured: with 1e-9 of the mean
// trace, cells of 0.1 m by 1e-5 m take twenty times the iterations).
constexpr double kMinRelativeShift = 1e-13;
// Total interpolation weight of neighbours' aggregates. Values above 1/2 invert the shortest waves.
constexpr double kInterpolation = 0.5;
constexpr double kLevelStiffness = 0.5;  // factor of the stiffness per level; see Preconditioner

Mat3 singular_shift(const Mat3& block) {
  const double trace = block.trace();
  return (trace > 0 ? kMinRelativeShift * trace : 1) * Mat3::Identity();
}

}  // namespace

// S_i block S_j, where S projects on the free directions.
template <class Real>
Mat3 Preconditioner<Real>::filtered(Index i, const Mat3& block, Index j) const {
  const Index ci = constraint_of_[at(i)], cj = constraint_of_[at(j)];
  Mat3 result = block;
  if (ci >= 0) result = system_->constraints[at(ci)].free * result;
  if (cj >= 0) result = result * system_->constraints[at(cj)].free;
  return result;
}

template <class Real>
void Preconditioner<Real>::prepare(const LinearSystem& system, AggregateSums sums) {
  const bool same_constraints =
      std::equal(constraints_.begin(), constraints_.end(), system.constraints.begin(), system.constraints.end(),
                 [](const auto& a, const auto& b) { return a.particle == b.particle && a.free == b.free; });
  const LinearSystem* const system_before = std::exchange(system_, &system);
  const bool interpolated_before = std::exchange(interpolates_, !has_stiff_threads());
  const bool same_levels = system_before == &system && interpolated_before == interpolates_;
  const bool same = same_levels && same_constraints;
  const std::vector<DiagonalBlock> before = std::exchange(blocks_, blocks_of(system));
  if (!same_levels) allocate_levels();
  if (!same) {
    constraints_ = system.constraints;
    constraint_of_.assign(at(system.matrix.rows()), -1);
    filters_.assign(blocks_.size(), {});
    for (std::size_t c = 0; c < constraints_.size(); ++c) {
      const Index particle = constraints_[c].particle;
      constraint_of_[at(particle)] = static_cast<Index>(c);
      filters_[block_of_row(blocks_, particle)].push_back({particle, PaddedMat3<Real>(constraints_[c].free)});
    }
  }
  rows_changed_.resize(blocks_.size());
  sums_changed_.resize(blocks_.size());
  summed_version_.resize(blocks_.size());
  for (std::size_t p = 0; p < blocks_.size(); ++p) {
    rows_changed_[p] = !same || blocks_[p].version != before[p].version;
    sums_changed_[p] = !same || (sums == AggregateSums::recompute && blocks_[p].version != summed_version_[p]);
    if (sums_changed_[p]) summed_version_[p] = blocks_[p].version;
  }
  mark_particles_with_terms();
  if (levels_.empty()) return invert_particles();
  parallel_for(blocks_.size(), 1, [&](std::size_t p, std::size_t) {
    if (sums_changed_[p]) sum_aggregate_blocks(p);
  });
  parallel_invoke([&] { factorise_coarsest(); },
                  [&] {
                    invert_particles();
                    invert_aggregates();
                  });
}

template <class Real>
void Preconditioner<Real>::select(std::span<const std::size_t> blocks) {
  if (std::ranges::equal(blocks, selected_)) return;
  selected_.assign(blocks.begin(), blocks.end());
  rows_ = RowChunks(ranges_of(blocks_, selected_), kGrainSize);
  for (Level& level : levels_) {
    std::vector<RowRange> ranges;
    for (std::size_t p : selected_) ranges.push_back(level.of_block[p]);
    // An aggregate costs more than a particle: it has about twelve members.
    level.chunks = RowChunks(ranges, kGrainSize / 4);
  }
}

template <class Real>
bool Preconditioner<Real>::has_stiff_threads() const {
  if (system_->norm_weights.empty()) return false;
  return std::ranges::any_of(blocks_of(*system_), [&](const DiagonalBlock& rows) {
    if (rows.is_small) return false;
    const double norm_weights =
        parallel_sum(at(rows.end - rows.begin), kGrainSize, [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          for (std::size_t k = begin; k < end; ++k) sum += system_->norm_weights[at(rows.begin) + k];
          return sum;
        });
    return !parallel_all_of(at(rows.end - rows.begin), [&](std::size_t k) {
      return !(system_->matrix.trace(rows.begin + static_cast<Index>(k)) >
               numerics.linear.stiff_particle * norm_weights);
    });
  });
}

template <class Real>
void Preconditioner<Real>::allocate_levels() {
  const std::size_t rows = at(system_->matrix.rows());
  inverse_.resize(rows);
  has_terms_.assign(rows, 0);
  assert(system_->aggregate_levels.size() <= kMaxAggregateLevels);
  levels_.resize(system_->aggregate_levels.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Aggregates& aggregates = system_->aggregate_levels[l];
    Level& level = levels_[l];
    level.aggregate_of = aggregates.of;
    if (l > 0) {
      level.aggregate_of = levels_[l - 1].aggregate_of;
      for (Index& group : level.aggregate_of) group = aggregates.of[at(group)];
    }
    level.parent = l + 1 < levels_.size() ? system_->aggregate_levels[l + 1].of : std::vector<Index>();
    level.of_matrix.assign(at(aggregates.count), Mat3::Zero());
    level.has_terms.assign(at(aggregates.count), 0);
    level.inverse.resize(at(aggregates.count));
    for (auto* v : {&level.residual, &level.correction}) v->assign(at(aggregates.count), PaddedVec3<Real>{});
    level.of_block.clear();
    for (const DiagonalBlock& block : blocks_) {
      const auto [lowest, highest] =
          std::minmax_element(level.aggregate_of.begin() + block.begin, level.aggregate_of.begin() + block.end);
      level.of_block.push_back(block.begin == block.end ? RowRange{} : RowRange{at(*lowest), at(*highest) + 1});
    }
  }
  selected_.clear();
  if (levels_.empty()) return;
  const Index size = 3 * system_->aggregate_levels.back().count;
  coarse_matrix_without_terms_.setZero(size, size);
  members_of_coarse_.assign(at(system_->aggregate_levels.back().count), {});
  for (std::size_t i = 0; i < rows; ++i)
    members_of_coarse_[at(levels_.back().aggregate_of[i])].push_back(static_cast<Index>(i));
  compute_weights();
  find_common_levels();
}

// Particles with a common full block are neighbours; so are aggregates with neighbouring members.
template <class Real>
void Preconditioner<Real>::compute_weights() {
  const double smoothing = interpolates_ ? kInterpolation : 0;
  const BlockMatrix::Pattern& full = system_->matrix.full();
  std::vector<std::vector<Index>> neighbours(inverse_.size());
  // Each particle of a small diagonal block is an aggregate of its own, and interpolates from no other.
  std::vector<char> is_small(neighbours.size(), 0);
  for (const DiagonalBlock& block : blocks_)
    if (block.is_small) std::fill(is_small.begin() + block.begin, is_small.begin() + block.end, 1);
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (Index s = full.start[i]; s < full.start[i + 1]; ++s)
      if (full.columns[s] != static_cast<Index>(i) && is_small[i] == 0) neighbours[i].push_back(full.columns[s]);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Aggregates& aggregates = system_->aggregate_levels[l];
    Weights<Real>& weights = levels_[l].interpolation =
        Weights<Real>::make_interpolation(aggregates, smoothing, neighbours);
    coarse_weights_ = l == 0 ? weights : coarse_weights_.times(weights);
    levels_[l].restriction = weights.transposed(at(aggregates.count));
  }
}

template <class Real>
void Preconditioner<Real>::find_common_levels() {
  const auto find = [&](const BlockMatrix::Pattern& pattern, std::vector<std::uint8_t>& shared) {
    shared.clear(), shared.reserve(pattern.columns.size());
    for (std::size_t i = 0; i + 1 < pattern.start.size(); ++i)
      for (Index s = pattern.start[i]; s < pattern.start[i + 1]; ++s) {
        // Aggregates are nested: particles that share one on some level do so on all coarser levels.
        std::size_t l = 0;
        while (l < levels_.size() && levels_[l].aggregate_of[i] != levels_[l].aggregate_of[at(pattern.columns[s])]) ++l;
        shared.push_back(static_cast<std::uint8_t>(l));
      }
  };
  find(system_->matrix.full(), common_level_full_);
  find(system_->matrix.isotropic(), common_level_isotropic_);
}

// Marks the particles on which contact terms act: their blocks change whenever the terms change.
template <class Real>
void Preconditioner<Real>::mark_particles_with_terms() {
  had_terms_ = has_terms_;
  std::ranges::fill(has_terms_, 0);
  for (const DiagonalTerm& term : system_->diagonal_terms) has_terms_[at(term.particle)] = 1;
  for_each_term(*system_, [&](const auto& term) {
    for (std::size_t a = 0; a < term.particles.size(); ++a)
      if (term.weights[a] != 0) has_terms_[at(term.particles[a])] = 1;
  });
}

template <class Real>
void Preconditioner<Real>::invert_particles() {
  BlocksWithTerms with_terms = make_blocks_with_terms();
  for (std::size_t i = 0; i < has_terms_.size(); ++i)
    if (has_terms_[i]) with_terms.of(static_cast<Index>(i)) = own_block(static_cast<Index>(i));
  for (const DiagonalTerm& term : system_->diagonal_terms) with_terms.of(term.particle) += term.stiffness;
  for_each_term(*system_, [&](const auto& term) {
    for (std::size_t a = 0; a < term.particles.size(); ++a)
      if (const double w = term.weights[a]; w != 0) with_terms.of(term.particles[a]) += w * w * term.stiffness;
  });
  const auto invert = [&](Index i) {
    const Mat3 block = has_terms_[at(i)] ? with_terms.of(i) : own_block(i);
    Mat3 inverse;
    if (const Index c = constraint_of_[at(i)]; c < 0) {
      inverse = block.inverse();
    } else {
      const Mat3 &free = constraints_[at(c)].free, held = Mat3::Identity() - free;
      inverse = free * (free * block * free + held).inverse() * free;
    }
    inverse_[at(i)] = PaddedMat3<Real>(inverse);
  };
  for (std::size_t p = 0; p < blocks_.size(); ++p)
    parallel_for(at(blocks_[p].end - blocks_[p].begin), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = at(blocks_[p].begin) + begin; i < at(blocks_[p].begin) + end; ++i)
        if (rows_changed_[p] || has_terms_[i] || had_terms_[i]) invert(static_cast<Index>(i));
    });
}

// Sums the stiffness of one diagonal block (its matrix without the mass part). A 3×3 block enters the finest aggregate
// that contains its row and its column, and thus all coarser ones. If there is none, it enters the coarsest matrix.
template <class Real>
void Preconditioner<Real>::sum_aggregate_blocks(std::size_t index) {
  const std::size_t depth = levels_.size();
  for (Level& level : levels_)
    for (std::size_t g = level.of_block[index].begin; g < level.of_block[index].end; ++g) level.of_matrix[g].setZero();
  const auto first = static_cast<Eigen::Index>(3 * levels_.back().of_block[index].begin);
  const auto last = static_cast<Eigen::Index>(3 * levels_.back().of_block[index].end);
  coarse_matrix_without_terms_.block(first, first, last - first, last - first).setZero();
  const std::vector<Index>& coarse_of = levels_.back().aggregate_of;
  const BlockMatrix& matrix = system_->matrix;
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  const double stiffness_fraction =
      interpolates_ && !blocks_[index].is_small ? std::pow(kLevelStiffness, static_cast<double>(depth)) : 1;
  const auto add_to_coarse = [&](Index i, Index j, const auto& block) {
    // The factorisation reads the lower triangle only.
    const Index coarse_i = coarse_of[at(i)], coarse_j = coarse_of[at(j)];
    if (coarse_i > coarse_j)
      coarse_matrix_without_terms_.block<3, 3>(3 * coarse_i, 3 * coarse_j) += stiffness_fraction * block;
  };
  // Aggregates are nested, so threads can sum different coarsest aggregates at the same time.
  const auto sum_row = [&](Index i) {
    std::array<Mat3, kMaxAggregateLevels> own;
    std::array<double, kMaxAggregateLevels> own_scalars{};
    std::fill_n(own.begin(), depth, Mat3::Zero());
    std::fill_n(own_scalars.begin(), depth, 0.0);
    const double weight = system_->norm_weights.empty() ? 0 : system_->norm_weights[i];
    own[0] -= filtered(i, weight * Mat3::Identity(), i);
    for (Index s = full.start[i]; s < full.start[i + 1]; ++s) {
      const Index j = full.columns[s];
      const Eigen::Map<const Mat3> block(matrix.values().data() + 9 * at(s));
      const std::size_t level = common_level_full_[s];
      if (is_free(i) && is_free(j))
        level < depth ? void(own[level] += block) : add_to_coarse(i, j, block);
      else
        level < depth ? void(own[level] += filtered(i, block, j)) : add_to_coarse(i, j, filtered(i, block, j));
    }
    for (Index s = isotropic.start[i]; s < isotropic.start[i + 1]; ++s) {
      const Index j = isotropic.columns[s];
      const double scalar = matrix.scalars()[s];
      const std::size_t level = common_level_isotropic_[s];
      if (is_free(i) && is_free(j)) {
        level < depth ? void(own_scalars[level] += scalar) : add_to_coarse(i, j, scalar * Mat3::Identity());
        continue;
      }
      const Mat3 block = filtered(i, scalar * Mat3::Identity(), j);
      level < depth ? void(own[level] += block) : add_to_coarse(i, j, block);
    }
    for (std::size_t l = 0; l < depth; ++l) {
      Mat3& of_group = levels_[l].of_matrix[at(levels_[l].aggregate_of[i])];
      of_group += own[l];
      of_group.diagonal().array() += own_scalars[l];
    }
  };
  parallel_for(at(last - first) / 3, 1, [&](std::size_t aggregate, std::size_t) {
    for (Index i : members_of_coarse_[levels_.back().of_block[index].begin + aggregate]) sum_row(i);
  });
  for (std::size_t l = 1; l < depth; ++l)
    for (std::size_t g = levels_[l - 1].of_block[index].begin; g < levels_[l - 1].of_block[index].end; ++g)
      levels_[l].of_matrix[at(levels_[l - 1].parent[g])] += levels_[l - 1].of_matrix[g];
  scale_sums(index);
}

// Scales the sums of a diagonal block by the stiffness fraction of their level, and adds the parts that are the same on
// all levels: the mass part, and the stiffness along held directions.
template <class Real>
void Preconditioner<Real>::scale_sums(std::size_t index) {
  const auto unscaled_block_of = [&](Index i) -> Mat3 {
    Mat3 unscaled = (system_->norm_weights.empty() ? 0 : system_->norm_weights[i]) * Mat3::Identity();
    if (is_free(i)) return unscaled;
    const Mat3 free = constraints_[at(constraint_of_[i])].free, held = Mat3::Identity() - free;
    return free * unscaled * free + held * own_block(i) * held;
  };
  std::vector<Mat3> unscaled;  // of the previous level: per aggregate of this diagonal block
  double stiffness_fraction = 1;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    if (interpolates_ && !blocks_[index].is_small) stiffness_fraction *= kLevelStiffness;
    const RowRange groups = level.of_block[index];
    const RowRange members =
        l == 0 ? RowRange{at(blocks_[index].begin), at(blocks_[index].end)} : levels_[l - 1].of_block[index];
    std::vector<Mat3> sums(groups.end - groups.begin, Mat3::Zero());
    for (std::size_t m = members.begin; m < members.end; ++m)
      sums[at(system_->aggregate_levels[l].of[m]) - groups.begin] +=
          l == 0 ? unscaled_block_of(static_cast<Index>(m)) : unscaled[m - members.begin];
    for (std::size_t g = groups.begin; g < groups.end; ++g)
      level.of_matrix[g] = stiffness_fraction * level.of_matrix[g] + sums[g - groups.begin];
    unscaled = std::move(sums);
  }
  const Level& coarsest = levels_.back();
  const RowRange groups = coarsest.of_block[index];
  for (std::size_t g = groups.begin; g < groups.end; ++g)
    coarse_matrix_without_terms_.block<3, 3>(static_cast<Eigen::Index>(3 * g), static_cast<Eigen::Index>(3 * g)) +=
        coarsest.of_matrix[g];
}

// Returns a zero block for each particle with contact terms (few of a large cloth), and none for other particles.
template <class Real>
typename Preconditioner<Real>::BlocksWithTerms Preconditioner<Real>::make_blocks_with_terms() const {
  BlocksWithTerms all{std::vector<Index>(has_terms_.size(), -1), {}};
  for (std::size_t i = 0; i < has_terms_.size(); ++i) {
    if (!has_terms_[i]) continue;
    all.place[i] = static_cast<Index>(all.blocks.size());
    all.blocks.push_back(Mat3::Zero());
  }
  return all;
}

// Contact stiffness that acts on each particle if all particles whose weights have the same sign move with it.
template <class Real>
typename Preconditioner<Real>::BlocksWithTerms Preconditioner<Real>::lump_terms() const {
  BlocksWithTerms lumped = make_blocks_with_terms();
  const auto add = [&](Index i, double weight, const Mat3& stiffness) {
    lumped.of(i) += filtered(i, weight * stiffness, i);
  };
  for (const DiagonalTerm& term : system_->diagonal_terms) add(term.particle, 1, term.stiffness);
  for_each_term(*system_, [&](const auto& term) {
    double of_a = 0, of_b = 0;
    for (const double w : term.weights) (w > 0 ? of_a : of_b) += w;
    for (std::size_t k = 0; k < term.particles.size(); ++k)
      if (const double w = term.weights[k]; w != 0) add(term.particles[k], w * (w > 0 ? of_a : of_b), term.stiffness);
  });
  return lumped;
}

// The block of an aggregate contains the contact stiffness of all particles that interpolate from it, with these
// weights. If it contained only that of its own particles, aggregates between scattered contacts would count as free.
template <class Real>
void Preconditioner<Real>::invert_aggregates() {
  const BlocksWithTerms of_particles = lump_terms();
  std::vector<Mat3> of_members;  // of the previous level: contact stiffness per aggregate
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    Level& level = levels_[l];
    // True for aggregates of changed diagonal blocks, and for those with contact terms now or at the last call.
    std::vector<char> needs_inverse = level.has_terms;
    std::ranges::fill(level.has_terms, 0);
    std::vector<Mat3> of_groups(needs_inverse.size(), Mat3::Zero());
    const std::vector<char>& has_terms = l == 0 ? has_terms_ : levels_[l - 1].has_terms;
    for (std::size_t m = 0; m < has_terms.size(); ++m) {
      if (!has_terms[m]) continue;
      for (Index s = level.interpolation.start[m]; s < level.interpolation.start[m + 1]; ++s) {
        const std::size_t group = at(level.interpolation.columns[s]);
        level.has_terms[group] = needs_inverse[group] = 1;
        of_groups[group] += static_cast<double>(level.interpolation.values[s]) *
                            (l == 0 ? of_particles.of(static_cast<Index>(m)) : of_members[m]);
      }
    }
    for (std::size_t p = 0; p < blocks_.size(); ++p)
      if (sums_changed_[p])
        std::fill(needs_inverse.begin() + static_cast<std::ptrdiff_t>(level.of_block[p].begin),
                  needs_inverse.begin() + static_cast<std::ptrdiff_t>(level.of_block[p].end), 1);
    parallel_for(needs_inverse.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        if (!needs_inverse[g]) continue;
        const Mat3 block = level.of_matrix[g] + of_groups[g];
        level.inverse[g] = PaddedMat3<Real>((block + singular_shift(block)).inverse());
      }
    });
    of_members = std::move(of_groups);
  }
}

// Adds the contact terms exactly to the matrix of the coarsest level, and factorises it.
template <class Real>
void Preconditioner<Real>::factorise_coarsest() {
  coarse_matrix_ = coarse_matrix_without_terms_;
  // The coarsest aggregates from which particles of a term interpolate, and their weights.
  using CoarseWeights = std::vector<std::pair<Index, double>>;
  const auto add_coarse_weights = [&](Index i, double weight, CoarseWeights& weights_of_end) {
    for (Index s = coarse_weights_.start[i]; weight != 0 && s < coarse_weights_.start[i + 1]; ++s) {
      const auto known =
          std::ranges::find(weights_of_end, coarse_weights_.columns[s], &CoarseWeights::value_type::first);
      (known == weights_of_end.end() ? weights_of_end.emplace_back(coarse_weights_.columns[s], 0) : *known).second +=
          weight * coarse_weights_.values[s];
    }
  };
  const auto add = [&](const CoarseWeights& rows, const Mat3& stiffness, const CoarseWeights& columns) {
    for (const auto& [g, of_g] : rows)
      for (const auto& [h, of_h] : columns)
        if (g >= h) coarse_matrix_.block<3, 3>(3 * g, 3 * h) += of_g * of_h * stiffness;
  };
  std::array<CoarseWeights, 8> of;
  for (const DiagonalTerm& term : system_->diagonal_terms) {
    of[0].clear();
    add_coarse_weights(term.particle, 1, of[0]);
    add(of[0], filtered(term.particle, term.stiffness, term.particle), of[0]);
  }
  for_each_term(*system_, [&](const auto& term) {
    // If all particles are free, sums their weights first. If one is constrained, filters the term for each particle.
    const std::size_t count = term.particles.size();
    const bool free = std::ranges::all_of(term.particles, [&](Index i) { return is_free(i); });
    for (CoarseWeights& weights_of_end : of) weights_of_end.clear();
    for (std::size_t k = 0; k < count; ++k) add_coarse_weights(term.particles[k], term.weights[k], of[free ? 0 : k]);
    for (std::size_t a = 0; a < (free ? 1 : count); ++a)
      for (std::size_t b = 0; b < (free ? 1 : count); ++b)
        add(of[a], free ? term.stiffness : filtered(term.particles[a], term.stiffness, term.particles[b]), of[b]);
  });
  for (Eigen::Index g = 0; g < coarse_matrix_.rows(); g += 3)
    coarse_matrix_.block<3, 3>(g, g) += singular_shift(coarse_matrix_.block<3, 3>(g, g));
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(coarse_matrix_);
  coarse_factor_ = coarse_matrix_.template cast<Real>();
}

// Sums the residual with the interpolation weights: from particles to the finest aggregates, then to coarser ones.
template <class Real>
void Preconditioner<Real>::restrict_residual(std::span<const PaddedVec3<Real>> r) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const auto members = l == 0 ? r : std::span<const PaddedVec3<Real>>(levels_[l - 1].residual);
    level.chunks.for_each([&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) level.residual[g] = level.restriction.sum(g, members);
    });
  }
}

// From the coarsest level to the finest: the correction of an aggregate is its inverse times its residual, plus the
// correction interpolated from the next coarser level.
template <class Real>
void Preconditioner<Real>::correct_aggregates() {
  Level& coarsest = levels_.back();
  coarse_vector_.setZero(coarse_factor_.rows());
  for (std::size_t p : selected_)
    for (std::size_t g = coarsest.of_block[p].begin; g < coarsest.of_block[p].end; ++g)
      for (int k = 0; k < 3; ++k) coarse_vector_[static_cast<Eigen::Index>(3 * g) + k] = coarsest.residual[g][k];
  coarse_factor_.template triangularView<Eigen::Lower>().solveInPlace(coarse_vector_);
  coarse_factor_.template triangularView<Eigen::Lower>().adjoint().solveInPlace(coarse_vector_);
  for (std::size_t g = 0; g < coarsest.correction.size(); ++g) {
    const Real* of_aggregate = coarse_vector_.data() + 3 * g;
    coarsest.correction[g] = padded(of_aggregate[0], of_aggregate[1], of_aggregate[2]);
  }
  for (std::size_t l = levels_.size() - 1; l-- > 0;) {
    Level& level = levels_[l];
    const Level& coarser = levels_[l + 1];
    level.chunks.for_each([&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        level.correction[g] = level.inverse[g] * level.residual[g] + coarser.interpolation.sum(g, coarser.correction);
    });
  }
}

template <class Real>
void Preconditioner<Real>::apply(std::span<const PaddedVec3<Real>> r, std::span<PaddedVec3<Real>> z,
                                 std::span<const std::size_t> blocks) {
  select(blocks);
  if (!levels_.empty()) {
    restrict_residual(r);
    correct_aggregates();
  }
  rows_.for_each([&](std::size_t begin, std::size_t end) {
    if (levels_.empty()) {
      for (std::size_t i = begin; i < end; ++i) z[i] = inverse_[i] * r[i];
      return;
    }
    const Level& level = levels_.front();
    for (std::size_t i = begin; i < end; ++i) z[i] = inverse_[i] * r[i] + level.interpolation.sum(i, level.correction);
  });
  for (std::size_t p : blocks)
    for (const Filter& filter : filters_[p]) z[filter.particle] = filter.free * z[filter.particle];
}

template class Preconditioner<float>;
template class Preconditioner<double>;

}  // namespace weft::solver
