#include "solver/incomplete_cholesky.hpp"

#include <Eigen/Cholesky>

#include "core/numerics.hpp"

namespace weft::solver {
namespace {

constexpr double kMaxShift = 10;

}  // namespace

// Reads the lower triangle of S (A + diagonal blocks of the terms) S + (I − S).
void IncompleteCholesky::read(const LinearSystem& system) {
  const Index rows = system.matrix.rows();
  std::vector<const Mat3*> free(at(rows), nullptr);
  for (const ParticleConstraint& c : system.constraints) free[at(c.particle)] = &c.free;
  // The lower triangle has half of the off-diagonal blocks, and the diagonal.
  const std::size_t blocks = (system.matrix.blocks() + at(rows)) / 2;
  row_start_.assign(1, 0);
  row_start_.reserve(at(rows) + 1);
  columns_.clear();
  columns_.reserve(blocks);
  factor_.clear();
  factor_.reserve(blocks);
  system.matrix.for_each_block(0, rows, [&](Index i, Index j, const auto& block) {
    if (j > i) return;
    columns_.push_back(j);
    factor_.push_back(block);
    if (j == i) row_start_.push_back(columns_.size());
  });
  const auto diagonal = [&](Index i) -> Mat3& { return factor_[row_start_[at(i) + 1] - 1]; };
  for (const DiagonalTerm& term : system.diagonal_terms) diagonal(term.particle) += term.stiffness;
  for_each_term(system, [&](const auto& term) {
    for (std::size_t k = 0; k < term.particles.size(); ++k)
      diagonal(term.particles[k]) += term.weights[k] * term.weights[k] * term.stiffness;
  });
  if (system.constraints.empty()) return;
  for (Index i = 0; i < rows; ++i)
    for (std::size_t s = row_start_[at(i)]; s < row_start_[at(i) + 1]; ++s) {
      const Mat3 *free_i = free[at(i)], *free_j = free[at(columns_[s])];
      if (free_i != nullptr) factor_[s] = (*free_i * factor_[s]).eval();
      if (free_j != nullptr) factor_[s] = (factor_[s] * *free_j).eval();
      if (columns_[s] == i && free_i != nullptr) factor_[s] += Mat3::Identity() - *free_i;
    }
}

bool IncompleteCholesky::factorise(const LinearSystem& system) {
  for (double shift = 0; shift <= kMaxShift; shift = shift == 0 ? numerics.linear.factor_shift : 4 * shift) {
    read(system);
    y_.resize(row_start_.size() - 1);
    if (try_factorise(shift)) return true;
  }
  return false;
}

// In place, row by row: L_ij = (A_ij − Σ_k L_ik L_jkᵀ) L_jj⁻ᵀ over the columns k < j that both rows have.
bool IncompleteCholesky::try_factorise(double shift) {
  for (std::size_t i = 0; i + 1 < row_start_.size(); ++i) {
    const std::size_t begin = row_start_[i], last = row_start_[i + 1] - 1;
    for (std::size_t s = begin; s < last; ++s) {
      const std::size_t j = at(columns_[s]), end_of_j = row_start_[j + 1] - 1;
      Mat3 sum = factor_[s];
      for (std::size_t p = begin, q = row_start_[j]; p < s && q < end_of_j;) {
        if (columns_[p] == columns_[q]) sum.noalias() -= factor_[p] * factor_[q].transpose();
        const bool step_p = columns_[p] <= columns_[q], step_q = columns_[q] <= columns_[p];
        p += step_p;
        q += step_q;
      }
      factor_[s].noalias() = sum * factor_[end_of_j].transpose();
    }
    Mat3 pivot = (1 + shift) * factor_[last];
    for (std::size_t s = begin; s < last; ++s) pivot.noalias() -= factor_[s] * factor_[s].transpose();
    const Eigen::LLT<Mat3> root(pivot);
    if (root.info() != Eigen::Success || !pivot.allFinite()) return false;
    factor_[last] = root.matrixL().solve(Mat3::Identity());
  }
  return true;
}

double IncompleteCholesky::add(double factor, std::span<const PaddedVec3<double>> r, std::span<PaddedVec3<double>> z,
                               std::span<const DiagonalBlock> parts) {
  double sum = 0;
  for (const DiagonalBlock& part : parts) {
    const std::size_t first = at(part.begin), end = at(part.end);
    for (std::size_t i = first; i < end; ++i) {
      Vec3 left = vec3_of(r[i]);
      const std::size_t last = row_start_[i + 1] - 1;
      for (std::size_t s = row_start_[i]; s < last; ++s) left.noalias() -= factor_[s] * y_[at(columns_[s])];
      y_[i].noalias() = factor_[last] * left;
    }
    for (std::size_t i = end; i-- > first;) {
      const std::size_t last = row_start_[i + 1] - 1;
      const Vec3 of_row = factor_[last].transpose() * y_[i];
      for (std::size_t s = row_start_[i]; s < last; ++s)
        y_[at(columns_[s])].noalias() -= factor_[s].transpose() * of_row;
      z[i] += factor * padded<double>(of_row);
      sum += factor * vec3_of(r[i]).dot(of_row);
    }
  }
  return sum;
}

}  // namespace weft::solver
