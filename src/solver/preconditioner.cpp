#include "solver/preconditioner.hpp"

#include <algorithm>
#include <array>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Rows per chunk: some 100 µs of work. With 1024, handing chunks to a second thread cost a tenth of the run on systems
// of 3,000 particles.
constexpr std::size_t kChunk = 4096;
// Levels of groups at most, patches included.
constexpr std::size_t kMaxLevels = 8;
// Where constraints leave a group no motion its block is zero, and so is its residual: any definite value will do, such
// as this share of the others.
constexpr double kStandIn = 1e-9;

std::size_t index(Index i) {
  return static_cast<std::size_t>(i);
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
  system_ = &system;
  constraint_of_.assign(index(system.matrix.rows()), -1);
  for (std::size_t c = 0; c < system.constraints.size(); ++c)
    constraint_of_[index(system.constraints[c].particle)] = static_cast<Index>(c);
  prepare_particles();
  if (system.groupings.empty()) return;

  levels_.resize(system.groupings.size() - 1);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].inverse.assign(index(system.groupings[l].count), Mat3::Zero());
    levels_[l].correction.resize(index(system.groupings[l].count));
  }
  const Index size = 3 * system.groupings.back().count;
  patch_matrix_.setZero(size, size);
  sum_blocks();
  sum_terms();

  for (Level& level : levels_) {
    double trace = 0;
    for (const Mat3& block : level.inverse) trace += block.trace();
    const double stand_in = trace > 0 ? kStandIn * trace / (3 * static_cast<double>(level.inverse.size())) : 1;
    for (Mat3& block : level.inverse) block = (block + stand_in * Mat3::Identity()).inverse().eval();
  }
  const double trace = patch_matrix_.trace();
  patch_matrix_.diagonal().array() += trace > 0 ? kStandIn * trace / size : 1;
  patch_solver_.compute(patch_matrix_);
}

void Preconditioner::prepare_particles() {
  const std::size_t rows = index(system_->matrix.rows());
  inverse_diagonal_.resize(rows);
  for (std::size_t i = 0; i < rows; ++i)
    inverse_diagonal_[i] = system_->matrix.block(system_->matrix.diagonal(static_cast<Index>(i)));
  for (const StencilTerm& term : system_->terms)
    for (int a = 0; a < 4; ++a)
      inverse_diagonal_[index(term.particles[a])] += term.weights[a] * term.weights[a] * term.stiffness;
  for (const ParticleConstraint& c : system_->constraints) {
    Mat3& block = inverse_diagonal_[index(c.particle)];
    block = c.free * block * c.free + (Mat3::Identity() - c.free);
  }
  parallel_for(rows, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inverse_diagonal_[i] = inverse_diagonal_[i].inverse().eval();
  });
  for (const ParticleConstraint& c : system_->constraints) {
    Mat3& inverse = inverse_diagonal_[index(c.particle)];
    inverse = c.free * inverse * c.free;
  }
}

// The blocks of the matrix, level by level. Most neighbours of a particle are in its own groups: their blocks are added
// up before they go into the level.
void Preconditioner::sum_blocks() {
  const std::size_t depth = levels_.size() + 1;
  std::array<const Index*, kMaxLevels> group_of{};
  for (std::size_t l = 0; l < depth; ++l) group_of[l] = system_->groupings[l].of.data();
  std::array<Mat3, kMaxLevels> own;
  Index row = -1;
  const auto finish_row = [&] {
    for (std::size_t l = 0; l + 1 < depth; ++l) levels_[l].inverse[index(group_of[l][row])] += own[l];
    const Index patch = 3 * group_of[depth - 1][row];
    patch_matrix_.block<3, 3>(patch, patch) += own[depth - 1];
  };
  const auto add = [&](Index i, Index j, const auto& block) {
    for (std::size_t l = 0; l < depth; ++l)
      if (group_of[l][i] == group_of[l][j]) own[l] += block;
    // The factorisation reads the lower triangle only.
    const Index patch_i = group_of[depth - 1][i], patch_j = group_of[depth - 1][j];
    if (patch_i > patch_j) patch_matrix_.block<3, 3>(3 * patch_i, 3 * patch_j) += block;
  };
  system_->matrix.for_each_block([&](Index i, Index j, const auto& block) {
    if (i != row) {
      if (row >= 0) finish_row();
      row = i;
      std::fill_n(own.begin(), depth, Mat3::Zero());
    }
    if (constraint_of_[index(i)] < 0 && constraint_of_[index(j)] < 0)
      add(i, j, block);
    else
      add(i, j, filtered(i, block, j));
  });
  if (row >= 0) finish_row();
}

void Preconditioner::sum_terms() {
  const std::vector<Index>& patch_of = system_->groupings.back().of;
  for (const StencilTerm& term : system_->terms) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const double weight = term.weights[a] * term.weights[b];
        if (weight == 0) continue;
        const Index i = term.particles[a], j = term.particles[b];
        const Mat3 block = filtered(i, weight * term.stiffness, j);
        for (std::size_t l = 0; l < levels_.size(); ++l) {
          const std::vector<Index>& group_of = system_->groupings[l].of;
          if (group_of[index(i)] == group_of[index(j)]) levels_[l].inverse[index(group_of[index(i)])] += block;
        }
        patch_matrix_.block<3, 3>(3 * patch_of[index(i)], 3 * patch_of[index(j)]) += block;
      }
    }
  }
}

double Preconditioner::apply(std::span<const Vec3> r, std::span<Vec3> z) {
  const bool coarse = !system_->groupings.empty();
  if (coarse) {
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      Level& level = levels_[l];
      const Index* group_of = system_->groupings[l].of.data();
      std::fill(level.correction.begin(), level.correction.end(), Vec3::Zero());
      for (std::size_t i = 0; i < r.size(); ++i) level.correction[index(group_of[i])] += r[i];
      for (std::size_t g = 0; g < level.inverse.size(); ++g)
        level.correction[g] = (level.inverse[g] * level.correction[g]).eval();
    }
    const Index* patch_of = system_->groupings.back().of.data();
    patch_residual_.setZero(patch_matrix_.rows());
    for (std::size_t i = 0; i < r.size(); ++i) patch_residual_.segment<3>(3 * patch_of[i]) += r[i];
    patch_correction_ = patch_solver_.solve(patch_residual_);
  }
  const double sum = parallel_sum(r.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) {
      z[i] = inverse_diagonal_[i] * r[i];
      if (coarse) {
        for (std::size_t l = 0; l < levels_.size(); ++l)
          z[i] += levels_[l].correction[index(system_->groupings[l].of[i])];
        z[i] += patch_correction_.segment<3>(3 * system_->groupings.back().of[i]);
      }
      part += r[i].dot(z[i]);
    }
    return part;
  });
  if (coarse) filter(z);
  return sum;
}

}  // namespace weft::solver
