#include "solver/preconditioner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/numerics.hpp"
#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Levels of groups at most, patches included.
constexpr std::size_t kMaxLevels = 16;
// Where constraints leave a group no motion its block has no inverse, and its residual is zero: a shift by this share
// of the block's own trace makes it definite. It must be below the share that masses have beside stiff threads: with
// 1e-9 of the mean trace, cells of 0.1 m by 1e-5 m took twenty times the iterations.
constexpr double kSingularShift = 1e-13;

Mat3 shift_of(const Mat3& block) {
  const double trace = block.trace();
  return (trace > 0 ? kSingularShift * trace : 1) * Mat3::Identity();
}

}  // namespace

// S_i A_ij S_j
template <class Real>
Mat3 Preconditioner<Real>::filtered(Index i, const Mat3& block, Index j) const {
  const Index ci = constraint_of_[at(i)], cj = constraint_of_[at(j)];
  Mat3 result = block;
  if (ci >= 0) result = system_->constraints[at(ci)].free * result;
  if (cj >= 0) result = result * system_->constraints[at(cj)].free;
  return result;
}

template <class Real>
void Preconditioner<Real>::prepare(const LinearSystem& system, Sums sums) {
  const bool same_constraints =
      std::equal(constraints_.begin(), constraints_.end(), system.constraints.begin(), system.constraints.end(),
                 [](const auto& a, const auto& b) { return a.particle == b.particle && a.free == b.free; });
  const LinearSystem* const system_before = std::exchange(system_, &system);
  const bool smooth_before = std::exchange(smooth_, !is_stiff());
  const bool same_levels = system_before == &system && smooth_before == smooth_;
  const bool same = same_levels && same_constraints;
  const std::vector<Part> before = std::exchange(parts_, parts_of(system));
  if (!same_levels) prepare_levels();
  if (!same) {
    constraints_ = system.constraints;
    constraint_of_.assign(at(system.matrix.rows()), -1);
    filters_.assign(parts_.size(), {});
    for (std::size_t c = 0; c < constraints_.size(); ++c) {
      const Index particle = constraints_[c].particle;
      constraint_of_[at(particle)] = static_cast<Index>(c);
      const auto part = std::ranges::find_if(parts_, [&](const Part& rows) { return particle < rows.end; });
      filters_[at(static_cast<Index>(part - parts_.begin()))].push_back(
          {particle, QuadBlock<Real>(constraints_[c].free)});
    }
  }
  changed_.resize(parts_.size());
  sums_changed_.resize(parts_.size());
  summed_.resize(parts_.size());
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    changed_[p] = !same || parts_[p].version != before[p].version;
    sums_changed_[p] = !same || (sums == Sums::anew && parts_[p].version != summed_[p]);
    if (sums_changed_[p]) summed_[p] = parts_[p].version;
  }
  mark_touched();
  if (levels_.empty()) return invert_particles();
  parallel_for(parts_.size(), 1, [&](std::size_t p, std::size_t) {
    if (sums_changed_[p]) sum_blocks(p);
  });
  parallel_invoke([&] { factorise_patches(); },
                  [&] {
                    invert_particles();
                    invert_groups();
                  });
}

template <class Real>
void Preconditioner<Real>::select(std::span<const std::size_t> parts) {
  if (std::ranges::equal(parts, selected_)) return;
  selected_.assign(parts.begin(), parts.end());
  rows_ = RowChunks(ranges_of(parts_, selected_), kGrainSize);
  for (Level& level : levels_) {
    std::vector<RowRange> ranges;
    for (std::size_t p : selected_) ranges.push_back(level.of_part[p]);
    // A group has some twelve members, or so many that it is interpolated from.
    level.groups = RowChunks(ranges, kGrainSize / 4);
  }
}

template <class Real>
bool Preconditioner<Real>::is_stiff() const {
  if (system_->metric.empty()) return false;
  return std::ranges::any_of(parts_of(*system_), [&](const Part& part) {
    if (part.is_small) return false;
    const double metric = parallel_sum(at(part.end - part.begin), kGrainSize, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum += system_->metric[at(part.begin) + k];
      return sum;
    });
    const auto stiff = [&](std::size_t i) {
      const double* block = system_->matrix.values().data() + 9 * at(system_->matrix.diagonal(static_cast<Index>(i)));
      return block[0] + block[4] + block[8] > numerics.linear.stiff_particle * metric;
    };
    return parallel_sum(at(part.end - part.begin), kGrainSize, [&](std::size_t begin, std::size_t end) {
             int any = 0;
             for (std::size_t k = begin; k < end; ++k) any |= stiff(at(part.begin) + k) ? 1 : 0;
             return any;
           }) > 0;
  });
}

// Who is in which group, and room for it all.
template <class Real>
void Preconditioner<Real>::prepare_levels() {
  const std::size_t rows = at(system_->matrix.rows());
  inverse_.resize(rows);
  touched_.assign(rows, 0);
  levels_.resize(system_->groupings.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Grouping& grouping = system_->groupings[l];
    Level& level = levels_[l];
    level.group_of = grouping.of;
    if (l > 0) {
      level.group_of = levels_[l - 1].group_of;
      for (Index& group : level.group_of) group = grouping.of[at(group)];
    }
    level.parent = l + 1 < levels_.size() ? system_->groupings[l + 1].of : std::vector<Index>();
    level.of_matrix.assign(at(grouping.count), Mat3::Zero());
    level.touched.assign(at(grouping.count), 0);
    level.inverse.resize(at(grouping.count));
    for (auto* vectors : {&level.residual, &level.correction}) vectors->assign(at(grouping.count), Quad<Real>{});
    level.of_part.clear();
    for (const Part& part : parts_) {
      const auto [least, most] =
          std::minmax_element(level.group_of.begin() + part.begin, level.group_of.begin() + part.end);
      level.of_part.push_back(part.begin == part.end ? RowRange{} : RowRange{at(*least), at(*most) + 1});
    }
  }
  selected_.clear();
  if (levels_.empty()) return;
  const Index size = 3 * system_->groupings.back().count;
  patches_of_matrix_.setZero(size, size);
  members_of_patch_.assign(at(system_->groupings.back().count), {});
  for (std::size_t i = 0; i < rows; ++i)
    members_of_patch_[at(levels_.back().group_of[i])].push_back(static_cast<Index>(i));
  find_weights();
  find_shared_levels();
}

// From full blocks: who shares one is a neighbour, and so are groups that neighbours are in.
template <class Real>
void Preconditioner<Real>::find_weights() {
  const double smoothing = smooth_ ? numerics.linear.interpolation : 0;
  const BlockMatrix::Pattern& full = system_->matrix.full();
  std::vector<std::vector<Index>> neighbours(inverse_.size());
  // Of small parts each particle is an aggregate of its own, and follows no other.
  std::vector<char> is_small(neighbours.size(), 0);
  for (const Part& part : parts_)
    if (part.is_small) std::fill(is_small.begin() + part.begin, is_small.begin() + part.end, 1);
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (Index s = full.start[i]; s < full.start[i + 1]; ++s)
      if (full.columns[s] != static_cast<Index>(i) && is_small[i] == 0) neighbours[i].push_back(full.columns[s]);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Grouping& grouping = system_->groupings[l];
    Weights<Real> weights = Weights<Real>::interpolating(grouping, smoothing, neighbours);
    of_patches_ = l == 0 ? weights : of_patches_.times(weights);
    levels_[l].of_members = weights.transposed(at(grouping.count));
    levels_[l].of_groups = std::move(weights);
  }
}

template <class Real>
void Preconditioner<Real>::find_shared_levels() {
  const auto find = [&](const BlockMatrix::Pattern& pattern, std::vector<std::uint8_t>& shared) {
    shared.clear();
    for (std::size_t i = 0; i + 1 < pattern.start.size(); ++i)
      for (Index s = pattern.start[i]; s < pattern.start[i + 1]; ++s) {
        // Groups are nested: whoever is in one with i on some level is so on all that follow.
        std::size_t l = 0;
        while (l < levels_.size() && levels_[l].group_of[i] != levels_[l].group_of[at(pattern.columns[s])]) ++l;
        shared.push_back(static_cast<std::uint8_t>(l));
      }
  };
  find(system_->matrix.full(), shared_full_);
  find(system_->matrix.isotropic(), shared_isotropic_);
}

// Particles and groups that terms act on: their blocks change with every set of terms, those of others with the matrix.
template <class Real>
void Preconditioner<Real>::mark_touched() {
  touched_before_ = touched_;
  std::ranges::fill(touched_, 0);
  for (const DiagonalTerm& term : system_->diagonal_terms) touched_[at(term.particle)] = 1;
  for_each_term(*system_, [&](const auto& term) {
    for (std::size_t a = 0; a < term.particles.size(); ++a)
      if (term.weights[a] != 0) touched_[at(term.particles[a])] = 1;
  });
}

template <class Real>
void Preconditioner<Real>::invert_particles() {
  TouchedBlocks with_terms = touched_blocks();
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (touched_[i]) with_terms.of(static_cast<Index>(i)) = own_block(static_cast<Index>(i));
  for (const DiagonalTerm& term : system_->diagonal_terms) with_terms.of(term.particle) += term.stiffness;
  for_each_term(*system_, [&](const auto& term) {
    for (std::size_t a = 0; a < term.particles.size(); ++a)
      if (const double w = term.weights[a]; w != 0) with_terms.of(term.particles[a]) += w * w * term.stiffness;
  });
  const auto invert = [&](Index i) {
    const Mat3 block = touched_[at(i)] ? with_terms.of(i) : own_block(i);
    Mat3 inverse;
    if (const Index c = constraint_of_[at(i)]; c < 0) {
      inverse = block.inverse();
    } else {
      const Mat3 &free = constraints_[at(c)].free, held = Mat3::Identity() - free;
      inverse = free * (free * block * free + held).inverse() * free;
    }
    inverse_[at(i)] = QuadBlock<Real>(inverse);
  };
  for (std::size_t p = 0; p < parts_.size(); ++p)
    parallel_for(at(parts_[p].end - parts_[p].begin), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = at(parts_[p].begin) + begin; i < at(parts_[p].begin) + end; ++i)
        if (changed_[p] || touched_[i] || touched_before_[i]) invert(static_cast<Index>(i));
    });
}

// The blocks of a part of the matrix but its metric, each into the first group that has both its row and its column,
// from there into larger and larger ones.
template <class Real>
void Preconditioner<Real>::sum_blocks(std::size_t part) {
  const std::size_t depth = levels_.size();
  for (Level& level : levels_)
    for (std::size_t g = level.of_part[part].begin; g < level.of_part[part].end; ++g) level.of_matrix[g].setZero();
  const auto first = static_cast<Eigen::Index>(3 * levels_.back().of_part[part].begin);
  const auto last = static_cast<Eigen::Index>(3 * levels_.back().of_part[part].end);
  patches_of_matrix_.block(first, first, last - first, last - first).setZero();
  const std::vector<Index>& patch_of = levels_.back().group_of;
  const BlockMatrix& matrix = system_->matrix;
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  const double share =
      smooth_ && !parts_[part].is_small ? std::pow(numerics.linear.level_stiffness, static_cast<double>(depth)) : 1;
  const auto add_to_patches = [&](Index i, Index j, const auto& block) {
    // The factorisation reads the lower triangle only.
    const Index patch_i = patch_of[at(i)], patch_j = patch_of[at(j)];
    if (patch_i > patch_j) patches_of_matrix_.block<3, 3>(3 * patch_i, 3 * patch_j) += share * block;
  };
  // Groups are nested, so that what one patch sums up no other does.
  const auto sum_row = [&](Index i) {
    std::array<Mat3, kMaxLevels> own;
    std::array<double, kMaxLevels> own_scalars{};
    std::fill_n(own.begin(), depth, Mat3::Zero());
    std::fill_n(own_scalars.begin(), depth, 0.0);
    if (!system_->metric.empty()) own[0] -= filtered(i, system_->metric[i] * Mat3::Identity(), i);
    for (Index s = full.start[i]; s < full.start[i + 1]; ++s) {
      const Index j = full.columns[s];
      const Eigen::Map<const Mat3> block(matrix.values().data() + 9 * at(s));
      const std::size_t level = shared_full_[s];
      if (is_free(i) && is_free(j))
        level < depth ? void(own[level] += block) : add_to_patches(i, j, block);
      else
        level < depth ? void(own[level] += filtered(i, block, j)) : add_to_patches(i, j, filtered(i, block, j));
    }
    for (Index s = isotropic.start[i]; s < isotropic.start[i + 1]; ++s) {
      const Index j = isotropic.columns[s];
      const double scalar = matrix.scalars()[s];
      const std::size_t level = shared_isotropic_[s];
      if (is_free(i) && is_free(j) && level < depth) {
        own_scalars[level] += scalar;
        continue;
      }
      const Mat3 block = filtered(i, scalar * Mat3::Identity(), j);
      level < depth ? void(own[level] += block) : add_to_patches(i, j, block);
    }
    for (std::size_t l = 0; l < depth; ++l) {
      Mat3& of_group = levels_[l].of_matrix[at(levels_[l].group_of[i])];
      of_group += own[l];
      of_group.diagonal().array() += own_scalars[l];
    }
  };
  parallel_for(at(last - first) / 3, 1, [&](std::size_t patch, std::size_t) {
    for (Index i : members_of_patch_[levels_.back().of_part[part].begin + patch]) sum_row(i);
  });
  for (std::size_t l = 1; l < depth; ++l)
    for (std::size_t g = levels_[l - 1].of_part[part].begin; g < levels_[l - 1].of_part[part].end; ++g)
      levels_[l].of_matrix[at(levels_[l - 1].parent[g])] += levels_[l - 1].of_matrix[g];
  scale_sums(part);
}

// Takes the share of the sums of a part that is left on their level, and adds what is the same on all of them: the
// metric, and what holds particles.
template <class Real>
void Preconditioner<Real>::scale_sums(std::size_t part) {
  const auto lasting_of = [&](Index i) -> Mat3 {
    Mat3 lasting = (system_->metric.empty() ? 0 : system_->metric[i]) * Mat3::Identity();
    if (is_free(i)) return lasting;
    const Mat3 free = constraints_[at(constraint_of_[i])].free, held = Mat3::Identity() - free;
    return free * lasting * free + held * own_block(i) * held;
  };
  std::vector<Mat3> lasting;  // of the members, from the part's first on, where these are groups
  double share = 1;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    if (smooth_ && !parts_[part].is_small) share *= numerics.linear.level_stiffness;
    const RowRange groups = level.of_part[part];
    const RowRange members =
        l == 0 ? RowRange{at(parts_[part].begin), at(parts_[part].end)} : levels_[l - 1].of_part[part];
    std::vector<Mat3> sums(groups.end - groups.begin, Mat3::Zero());
    for (std::size_t m = members.begin; m < members.end; ++m)
      sums[at(system_->groupings[l].of[m]) - groups.begin] +=
          l == 0 ? lasting_of(static_cast<Index>(m)) : lasting[m - members.begin];
    for (std::size_t g = groups.begin; g < groups.end; ++g)
      level.of_matrix[g] = share * level.of_matrix[g] + sums[g - groups.begin];
    lasting = std::move(sums);
  }
  const Level& patches = levels_.back();
  const RowRange groups = patches.of_part[part];
  for (std::size_t g = groups.begin; g < groups.end; ++g)
    patches_of_matrix_.block<3, 3>(static_cast<Eigen::Index>(3 * g), static_cast<Eigen::Index>(3 * g)) +=
        patches.of_matrix[g];
}

// Of zeros. Terms act on few of a large cloth's particles.
template <class Real>
typename Preconditioner<Real>::TouchedBlocks Preconditioner<Real>::touched_blocks() const {
  TouchedBlocks all{std::vector<Index>(touched_.size(), -1), {}};
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    if (!touched_[i]) continue;
    all.place[i] = static_cast<Index>(all.blocks.size());
    all.blocks.push_back(Mat3::Zero());
  }
  return all;
}

// Of each particle what the terms hold it with where all that is on its side of them moves with it.
template <class Real>
typename Preconditioner<Real>::TouchedBlocks Preconditioner<Real>::lumped_terms() const {
  TouchedBlocks lumped = touched_blocks();
  const auto add = [&](Index i, double weight, const Mat3& stiffness) {
    lumped.of(i) += is_free(i) ? Mat3(weight * stiffness) : filtered(i, weight * stiffness, i);
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

// A group's terms are those of its particles, and of others as far as these follow it. Without the latter, cloth that
// touches something here and there was taken for free beside it.
template <class Real>
void Preconditioner<Real>::invert_groups() {
  const TouchedBlocks of_particles = lumped_terms();
  std::vector<Mat3> of_members;  // where these are groups
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    Level& level = levels_[l];
    // Groups of changed parts and those that terms act on, or have acted on.
    std::vector<char> anew = level.touched;
    std::ranges::fill(level.touched, 0);
    std::vector<Mat3> of_groups(anew.size(), Mat3::Zero());
    const std::vector<char>& touched = l == 0 ? touched_ : levels_[l - 1].touched;
    for (std::size_t m = 0; m < touched.size(); ++m) {
      if (!touched[m]) continue;
      for (Index s = level.of_groups.start[m]; s < level.of_groups.start[m + 1]; ++s) {
        const std::size_t group = at(level.of_groups.columns[s]);
        level.touched[group] = anew[group] = 1;
        of_groups[group] += static_cast<double>(level.of_groups.values[s]) *
                            (l == 0 ? of_particles.of(static_cast<Index>(m)) : of_members[m]);
      }
    }
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (sums_changed_[p])
        std::fill(anew.begin() + static_cast<std::ptrdiff_t>(level.of_part[p].begin),
                  anew.begin() + static_cast<std::ptrdiff_t>(level.of_part[p].end), 1);
    parallel_for(anew.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        if (!anew[g]) continue;
        const Mat3 block = level.of_matrix[g] + numerics.linear.contact_weight * of_groups[g];
        level.inverse[g] = QuadBlock<Real>((block + shift_of(block)).inverse());
      }
    });
    of_members = std::move(of_groups);
  }
}

// Terms as the patches move what they couple.
template <class Real>
void Preconditioner<Real>::factorise_patches() {
  patch_matrix_ = patches_of_matrix_;
  // Patches, and how far the ends of a term follow each.
  using Shares = std::vector<std::pair<Index, double>>;
  const auto add_shares = [&](Index i, double weight, Shares& shares) {
    for (Index s = of_patches_.start[i]; weight != 0 && s < of_patches_.start[i + 1]; ++s) {
      const auto known = std::ranges::find(shares, of_patches_.columns[s], &Shares::value_type::first);
      (known == shares.end() ? shares.emplace_back(of_patches_.columns[s], 0) : *known).second +=
          weight * of_patches_.values[s];
    }
  };
  const auto add = [&](const Shares& rows, const Mat3& stiffness, const Shares& columns) {
    for (const auto& [g, of_g] : rows)
      for (const auto& [h, of_h] : columns)
        if (g >= h) patch_matrix_.block<3, 3>(3 * g, 3 * h) += of_g * of_h * stiffness;
  };
  std::array<Shares, 8> of;
  for (const DiagonalTerm& term : system_->diagonal_terms) {
    of[0].clear();
    add_shares(term.particle, 1, of[0]);
    add(of[0], filtered(term.particle, term.stiffness, term.particle), of[0]);
  }
  for_each_term(*system_, [&](const auto& term) {
    // What is free moves together; of what is not each particle is filtered by itself.
    const std::size_t count = term.particles.size();
    const bool free = std::ranges::all_of(term.particles, [&](Index i) { return is_free(i); });
    for (Shares& shares : of) shares.clear();
    for (std::size_t k = 0; k < count; ++k) add_shares(term.particles[k], term.weights[k], of[free ? 0 : k]);
    for (std::size_t a = 0; a < (free ? 1 : count); ++a)
      for (std::size_t b = 0; b < (free ? 1 : count); ++b)
        add(of[a], free ? term.stiffness : filtered(term.particles[a], term.stiffness, term.particles[b]), of[b]);
  });
  for (Eigen::Index g = 0; g < patch_matrix_.rows(); g += 3)
    patch_matrix_.block<3, 3>(g, g) += shift_of(patch_matrix_.block<3, 3>(g, g));
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(patch_matrix_);
  patch_factor_ = patch_matrix_.template cast<Real>();
}

// From particles to groups to larger groups.
template <class Real>
void Preconditioner<Real>::restrict_residual(std::span<const Quad<Real>> r) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const std::span<const Quad<Real>> members = l == 0 ? r : std::span<const Quad<Real>>(levels_[l - 1].residual);
    level.groups.for_each([&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) level.residual[g] = level.of_members.sum(g, members);
    });
  }
}

// From the largest groups down: each adds what the corrections of larger ones make of it.
template <class Real>
void Preconditioner<Real>::correct_groups() {
  Level& patches = levels_.back();
  patch_vector_.setZero(patch_factor_.rows());
  for (std::size_t p : selected_)
    for (std::size_t g = patches.of_part[p].begin; g < patches.of_part[p].end; ++g)
      for (int k = 0; k < 3; ++k) patch_vector_[static_cast<Eigen::Index>(3 * g) + k] = patches.residual[g][k];
  patch_factor_.template triangularView<Eigen::Lower>().solveInPlace(patch_vector_);
  patch_factor_.template triangularView<Eigen::Lower>().adjoint().solveInPlace(patch_vector_);
  for (std::size_t g = 0; g < patches.correction.size(); ++g) {
    const Real* of_patch = patch_vector_.data() + 3 * g;
    patches.correction[g] = quad_of(of_patch[0], of_patch[1], of_patch[2]);
  }
  for (std::size_t l = levels_.size() - 1; l-- > 0;) {
    Level& level = levels_[l];
    const Level& larger = levels_[l + 1];
    level.groups.for_each([&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        level.correction[g] = level.inverse[g] * level.residual[g] + larger.of_groups.sum(g, larger.correction);
    });
  }
}

template <class Real>
void Preconditioner<Real>::apply(std::span<const Quad<Real>> r, std::span<Quad<Real>> z,
                                 std::span<const std::size_t> parts) {
  select(parts);
  if (!levels_.empty()) {
    restrict_residual(r);
    correct_groups();
  }
  rows_.for_each([&](std::size_t begin, std::size_t end) {
    if (levels_.empty()) {
      for (std::size_t i = begin; i < end; ++i) z[i] = inverse_[i] * r[i];
      return;
    }
    const Level& level = levels_.front();
    for (std::size_t i = begin; i < end; ++i) z[i] = inverse_[i] * r[i] + level.of_groups.sum(i, level.correction);
  });
  for (std::size_t p : parts)
    for (const Filter& filter : filters_[p]) z[filter.particle] = filter.free * z[filter.particle];
}

template class Preconditioner<float>;
template class Preconditioner<double>;

}  // namespace weft::solver
