#include "solver/preconditioner.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Rows per chunk: some 100 µs of work. With 1024, handing chunks to a second thread cost a tenth of the run on systems
// of 3,000 particles.
constexpr std::size_t kChunk = 4096;
// Levels of groups at most, patches included.
constexpr std::size_t kMaxLevels = 16;
// Where constraints leave a group no motion its block has no inverse, and its residual is zero: a shift by this share
// of the block's own trace makes it definite. It must be below the share that masses have beside stiff threads: with
// 1e-9 of the mean trace, cells of 0.1 m by 1e-5 m took twenty times the iterations.
constexpr double kSingularShift = 1e-13;

std::size_t index(Index i) {
  return static_cast<std::size_t>(i);
}

Mat3 shift_of(const Mat3& block) {
  const double trace = block.trace();
  return (trace > 0 ? kSingularShift * trace : 1) * Mat3::Identity();
}

}  // namespace

void Preconditioner::filter(std::span<Vec3> b) const {
  for (const ParticleConstraint& c : system_->constraints) {
    Vec3& entry = b[index(c.particle)];
    entry = c.free * entry;
  }
}

// S_i A_ij S_j
Mat3 Preconditioner::filtered(Index i, const Mat3& block, Index j) const {
  const Index ci = constraint_of_[index(i)], cj = constraint_of_[index(j)];
  Mat3 result = block;
  if (ci >= 0) result = system_->constraints[index(ci)].free * result;
  if (cj >= 0) result = result * system_->constraints[index(cj)].free;
  return result;
}

void Preconditioner::prepare(const LinearSystem& system) {
  const bool same_constraints =
      std::equal(constraints_.begin(), constraints_.end(), system.constraints.begin(), system.constraints.end(),
                 [](const auto& a, const auto& b) { return a.particle == b.particle && a.free == b.free; });
  const bool same = system_ == &system && same_constraints;
  const std::vector<Part> before = std::exchange(parts_, parts_of(system));
  system_ = &system;
  if (!same) {
    constraints_ = system.constraints;
    constraint_of_.assign(index(system.matrix.rows()), -1);
    for (std::size_t c = 0; c < constraints_.size(); ++c)
      constraint_of_[index(constraints_[c].particle)] = static_cast<Index>(c);
    prepare_levels();
  }
  if (!levels_.empty())
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (!same || parts_[p].version != before[p].version) sum_blocks(p);
  prepare_particles();
  if (!levels_.empty()) add_terms();
}

// Who is in which group, and room for it all.
void Preconditioner::prepare_levels() {
  levels_.resize(system_->groupings.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Grouping& grouping = system_->groupings[l];
    Level& level = levels_[l];
    level.group_of = grouping.of;
    if (l > 0) {
      level.group_of = levels_[l - 1].group_of;
      for (Index& group : level.group_of) group = grouping.of[index(group)];
    }
    for (auto* blocks : {&level.of_matrix, &level.inverse}) blocks->assign(index(grouping.count), Mat3::Zero());
    for (auto* vectors : {&level.residual, &level.correction}) vectors->resize(index(grouping.count));
    level.of_part.clear();
    for (const Part& part : parts_) {
      const auto [least, most] =
          std::minmax_element(level.group_of.begin() + part.begin, level.group_of.begin() + part.end);
      level.of_part.push_back(part.begin == part.end ? Range{} : Range{index(*least), index(*most) + 1});
    }
  }
  if (levels_.empty()) return;
  const Index size = 3 * system_->groupings.back().count;
  patches_of_matrix_.setZero(size, size);
}

void Preconditioner::prepare_particles() {
  const std::size_t rows = index(system_->matrix.rows());
  inverse_diagonal_.resize(rows);
  for (std::size_t i = 0; i < rows; ++i)
    inverse_diagonal_[i] = system_->matrix.block(system_->matrix.diagonal(static_cast<Index>(i)));
  for (const DiagonalTerm& term : system_->diagonal_terms) inverse_diagonal_[index(term.particle)] += term.stiffness;
  for (const StencilTerm& term : system_->terms)
    for (int a = 0; a < 4; ++a)
      inverse_diagonal_[index(term.particles[a])] += term.weights[a] * term.weights[a] * term.stiffness;
  for (const ParticleConstraint& c : constraints_) {
    Mat3& block = inverse_diagonal_[index(c.particle)];
    block = c.free * block * c.free + (Mat3::Identity() - c.free);
  }
  parallel_for(rows, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inverse_diagonal_[i] = inverse_diagonal_[i].inverse().eval();
  });
  for (const ParticleConstraint& c : constraints_) {
    Mat3& inverse = inverse_diagonal_[index(c.particle)];
    inverse = c.free * inverse * c.free;
  }
}

// The blocks of a part of the matrix, level by level. Most neighbours of a particle are in its own groups: their blocks
// are added up before they go into the level.
void Preconditioner::sum_blocks(std::size_t part) {
  const std::size_t depth = levels_.size();
  for (Level& level : levels_)
    for (std::size_t g = level.of_part[part].begin; g < level.of_part[part].end; ++g) level.of_matrix[g].setZero();
  const auto first = static_cast<Eigen::Index>(3 * levels_.back().of_part[part].begin);
  const auto last = static_cast<Eigen::Index>(3 * levels_.back().of_part[part].end);
  patches_of_matrix_.block(first, first, last - first, last - first).setZero();
  std::array<const Index*, kMaxLevels> group_of{};
  for (std::size_t l = 0; l < depth; ++l) group_of[l] = levels_[l].group_of.data();
  std::array<Mat3, kMaxLevels> own;
  Index row = -1;
  const auto finish_row = [&] {
    for (std::size_t l = 0; l < depth; ++l) levels_[l].of_matrix[index(group_of[l][row])] += own[l];
    const Index patch = 3 * group_of[depth - 1][row];
    patches_of_matrix_.block<3, 3>(patch, patch) += own[depth - 1];
  };
  const auto add = [&](Index i, Index j, const auto& block) {
    // Groups are nested: whoever is in one with i on some level is so on all that follow.
    std::size_t l = depth;
    while (l > 0 && group_of[l - 1][i] == group_of[l - 1][j]) own[--l] += block;
    // The factorisation reads the lower triangle only.
    const Index patch_i = group_of[depth - 1][i], patch_j = group_of[depth - 1][j];
    if (patch_i > patch_j) patches_of_matrix_.block<3, 3>(3 * patch_i, 3 * patch_j) += block;
  };
  system_->matrix.for_each_block(parts_[part].begin, parts_[part].end, [&](Index i, Index j, const auto& block) {
    if (i != row) {
      if (row >= 0) finish_row();
      row = i;
      std::fill_n(own.begin(), depth, Mat3::Zero());
    }
    if (is_free(i) && is_free(j))
      add(i, j, block);
    else
      add(i, j, filtered(i, block, j));
  });
  if (row >= 0) finish_row();
}

void Preconditioner::add_terms() {
  for (Level& level : levels_) level.inverse = level.of_matrix;
  patch_matrix_ = patches_of_matrix_;
  const std::vector<Index>& patch_of = levels_.back().group_of;
  const auto add = [&](Index i, const Mat3& unfiltered, Index j) {
    const Mat3 block = is_free(i) && is_free(j) ? unfiltered : filtered(i, unfiltered, j);
    // Groups are nested, and the factorisation reads the lower triangle only.
    for (std::size_t l = levels_.size() - 1; l-- > 0;) {
      const Index group = levels_[l].group_of[index(i)];
      if (group != levels_[l].group_of[index(j)]) break;
      levels_[l].inverse[index(group)] += block;
    }
    const Index patch_i = patch_of[index(i)], patch_j = patch_of[index(j)];
    if (patch_i >= patch_j) patch_matrix_.block<3, 3>(3 * patch_i, 3 * patch_j) += block;
  };
  for (const DiagonalTerm& term : system_->diagonal_terms) add(term.particle, term.stiffness, term.particle);
  for (const StencilTerm& term : system_->terms)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (const double weight = term.weights[a] * term.weights[b]; weight != 0)
          add(term.particles[a], weight * term.stiffness, term.particles[b]);

  for (std::size_t l = 0; l + 1 < levels_.size(); ++l)
    for (Mat3& block : levels_[l].inverse) block = (block + shift_of(block)).inverse().eval();
  for (Eigen::Index g = 0; g < patch_matrix_.rows(); g += 3)
    patch_matrix_.block<3, 3>(g, g) += shift_of(patch_matrix_.block<3, 3>(g, g));
  patch_solver_.compute(patch_matrix_);
}

// From particles to groups to larger groups.
void Preconditioner::restrict_residual(std::span<const Vec3> r, std::span<const std::size_t> parts) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    std::vector<Vec3>& sums = levels_[l].residual;
    const std::span<const Vec3> members = l == 0 ? r : std::span<const Vec3>(levels_[l - 1].residual);
    const std::vector<Index>& of = system_->groupings[l].of;
    for (std::size_t p : parts) {
      const Range groups = levels_[l].of_part[p];
      for (std::size_t g = groups.begin; g < groups.end; ++g) sums[g].setZero();
      const Range range = l == 0 ? Range{index(parts_[p].begin), index(parts_[p].end)} : levels_[l - 1].of_part[p];
      for (std::size_t m = range.begin; m < range.end; ++m) sums[index(of[m])] += members[m];
    }
  }
}

// From the largest groups down: each adds the correction of the group that it is in.
void Preconditioner::correct_groups(std::span<const std::size_t> parts) {
  Level& patches = levels_.back();
  patch_vector_.setZero(patch_matrix_.rows());
  for (std::size_t p : parts)
    for (std::size_t g = patches.of_part[p].begin; g < patches.of_part[p].end; ++g)
      patch_vector_.segment<3>(3 * static_cast<Eigen::Index>(g)) = patches.residual[g];
  patch_solver_.solveInPlace(patch_vector_);
  for (std::size_t g = 0; g < patches.correction.size(); ++g)
    patches.correction[g] = patch_vector_.segment<3>(3 * static_cast<Eigen::Index>(g));
  for (std::size_t l = levels_.size() - 1; l-- > 0;) {
    Level& level = levels_[l];
    const std::vector<Index>& parent_of = system_->groupings[l + 1].of;
    for (std::size_t p : parts)
      for (std::size_t g = level.of_part[p].begin; g < level.of_part[p].end; ++g)
        level.correction[g] = level.inverse[g] * level.residual[g] + levels_[l + 1].correction[index(parent_of[g])];
  }
}

double Preconditioner::apply(std::span<const Vec3> r, std::span<Vec3> z, std::span<const std::size_t> parts) {
  if (!levels_.empty()) {
    restrict_residual(r, parts);
    correct_groups(parts);
  }
  double sum = 0;
  for (std::size_t p : parts) {
    const std::size_t first = index(parts_[p].begin);
    sum += parallel_sum(index(parts_[p].end) - first, kChunk, [&](std::size_t begin, std::size_t end) {
      double of_chunk = 0;
      for (std::size_t i = first + begin; i < first + end; ++i) {
        z[i] = inverse_diagonal_[i] * r[i];
        if (!levels_.empty()) z[i] += levels_.front().correction[index(system_->groupings.front().of[i])];
        of_chunk += r[i].dot(z[i]);
      }
      return of_chunk;
    });
  }
  if (!levels_.empty()) filter(z);
  return sum;
}

}  // namespace weft::solver
