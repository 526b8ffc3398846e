#include "physics/solver/product.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

BlockMatrix::Pattern without_diagonal(const BlockMatrix::Pattern& pattern) {
  BlockMatrix::Pattern result;
  result.start.reserve(pattern.start.size());
  result.start.assign(1, 0);
  result.columns.reserve(pattern.columns.size() + 1 - pattern.start.size());
  for (std::size_t row = 0; row + 1 < pattern.start.size(); ++row) {
    for (Index s = pattern.start[row]; s < pattern.start[row + 1]; ++s)
      if (pattern.columns[s] != static_cast<Index>(row)) result.columns.push_back(pattern.columns[s]);
    result.start.push_back(static_cast<Index>(result.columns.size()));
  }
  return result;
}

using Octet = float __attribute__((vector_size(32)));

Octet to_octet(const PaddedVec3<double>& low, const PaddedVec3<double>& high) {
  return __builtin_shufflevector(__builtin_convertvector(low, PaddedVec3<float>),
                                 __builtin_convertvector(high, PaddedVec3<float>), 0, 1, 2, 3, 4, 5, 6, 7);
}

// For each of the first eight entries of a block: the entry of v by which a product with v multiplies it.
Octet repeat_per_column(const PaddedVec3<float>& v) {
  return __builtin_shufflevector(v, v, 0, 0, 0, 1, 1, 1, 2, 2);
}

}  // namespace

void DifferenceMatrix::copy_pattern(const BlockMatrix& matrix) {
  layout_ = matrix.layout();
  full_ = without_diagonal(matrix.full());
  octets_.assign(full_.columns.size(), Octet{});
  ninths_.assign(full_.columns.size(), 0);
  octets_of_sum_.assign(static_cast<std::size_t>(matrix.rows()), Octet{});
  ninths_of_sum_.assign(static_cast<std::size_t>(matrix.rows()), 0);
  scalars_.assign(matrix.isotropic().columns.size(), 0);
}

void DifferenceMatrix::copy_rows(const BlockMatrix& matrix, std::size_t begin, std::size_t end) {
  const BlockMatrix::Pattern &full = matrix.full(), &isotropic = matrix.isotropic();
  for (std::size_t row = begin; row < end; ++row) {
    const double* from = matrix.values().data() + 9 * static_cast<std::size_t>(full.start[row]);
    auto to = static_cast<std::size_t>(full_.start[row]);
    PaddedVec3<double> low{}, high{};
    double last = 0, scalars = 0;
    for (Index s = full.start[row]; s < full.start[row + 1]; ++s, from += 9) {
      const PaddedVec3<double> low_of_block = load_padded(from), high_of_block = load_padded(from + 4);
      low += low_of_block;
      high += high_of_block;
      last += from[8];
      if (full.columns[s] == static_cast<Index>(row)) continue;
      octets_[to] = to_octet(low_of_block, high_of_block);
      ninths_[to++] = static_cast<float>(from[8]);
    }
    for (Index s = isotropic.start[row]; s < isotropic.start[row + 1]; ++s) {
      scalars += matrix.scalars()[s];
      scalars_[s] = static_cast<float>(matrix.scalars()[s]);
    }
    octets_of_sum_[row] =
        to_octet(low + PaddedVec3<double>{scalars, 0, 0, 0}, high + PaddedVec3<double>{scalars, 0, 0, 0});
    ninths_of_sum_[row] = static_cast<float>(last + scalars);
  }
}

void DifferenceMatrix::multiply(std::span<const PaddedVec3<float>> x, std::span<PaddedVec3<float>> y, std::size_t begin,
                                std::size_t end) const {
  const BlockMatrix::Pattern& isotropic_pattern = layout_->isotropic;
  for (std::size_t row = begin; row < end; ++row) {
    const PaddedVec3<float> own = x[row];
    // Products with the three columns, side by side; only lane 2 of `ninth` is used.
    Octet sum = octets_of_sum_[row] * repeat_per_column(own);
    PaddedVec3<float> ninth = ninths_of_sum_[row] * own, isotropic{};
    for (Index s = full_.start[row]; s < full_.start[row + 1]; ++s) {
      const PaddedVec3<float> difference = x[full_.columns[s]] - own;
      sum += octets_[s] * repeat_per_column(difference);
      ninth += ninths_[s] * difference;
    }
    // The diagonal block is always full, never isotropic.
    for (Index s = isotropic_pattern.start[row]; s < isotropic_pattern.start[row + 1]; ++s)
      isotropic += scalars_[s] * (x[isotropic_pattern.columns[s]] - own);
    const PaddedVec3<float> of_first = __builtin_shufflevector(sum, sum, 0, 1, 2, 3),
                            of_second = __builtin_shufflevector(sum, sum, 3, 4, 5, 6),
                            of_third = __builtin_shufflevector(sum, sum, 6, 7, 6, 7);
    const PaddedVec3<float> third = __builtin_shufflevector(of_third, ninth, 0, 1, 6, 7);
    y[row] = clear_last_lane((of_first + of_second) + (third + isotropic));
  }
}

Mat3 DifferenceMatrix::sum_of_row(std::size_t row) const {
  Mat3 sum;
  for (int k = 0; k < 8; ++k) sum(k % 3, k / 3) = octets_of_sum_[row][k];
  sum(2, 2) = ninths_of_sum_[row];
  return sum;
}

template <class Real>
void Product<Real>::prepare(const LinearSystem& system) {
  const bool is_new_system = std::exchange(system_, &system) != &system;
  const std::vector<DiagonalBlock> before = std::exchange(blocks_, blocks_of(*system_));
  norm_weights_.assign(system_->norm_weights.begin(), system_->norm_weights.end());
  if constexpr (std::is_same_v<Real, float>) {
    if (is_new_system) matrix_.copy_pattern(system_->matrix);
    for (std::size_t p = 0; p < blocks_.size(); ++p) {
      if (!is_new_system && blocks_[p].version == before[p].version) continue;
      const auto first = static_cast<std::size_t>(blocks_[p].begin), end = static_cast<std::size_t>(blocks_[p].end);
      parallel_for(end - first, kFineGrainSize,
                   [&](std::size_t a, std::size_t b) { matrix_.copy_rows(system_->matrix, first + a, first + b); });
    }
  }
}

template <class Real>
template <class Term, std::size_t N, class IsInside>
void Product<Real>::add_stencil(const Term& term, const IsInside& is_inside, std::vector<Stencil<N>>& stencils) {
  bool acts = false;
  for (std::size_t k = 0; k < N && !acts; ++k) acts = term.weights[k] != 0 && is_inside(term.particles[k]);
  if (!acts) return;
  Stencil<N>& stencil = stencils.emplace_back(Stencil<N>{term.particles, {}, PaddedMat3<Real>(term.stiffness)});
  for (std::size_t k = 0; k < N; ++k) stencil.weights[k] = static_cast<Real>(term.weights[k]);
}

template <class Real>
void Product<Real>::select(std::span<const std::size_t> blocks) {
  selected_.assign(blocks.begin(), blocks.end());
  rows_ = RowChunks(ranges_of(blocks_, selected_), kGrainSize);
  const auto is_inside = [&](Index particle) {
    return blocks.size() == blocks_.size() || std::ranges::any_of(blocks, [&](std::size_t p) {
             return particle >= blocks_[p].begin && particle < blocks_[p].end;
           });
  };
  stencils_.clear();
  for (const StencilTerm& term : system_->terms) add_stencil(term, is_inside, stencils_);
  wide_stencils_.clear();
  for (const WideTerm& term : system_->wide_terms) add_stencil(term, is_inside, wide_stencils_);
  terms_.clear();
  for (const DiagonalTerm& term : system_->diagonal_terms)
    if (is_inside(term.particle)) terms_.push_back({term.particle, PaddedMat3<Real>(term.stiffness)});
  filters_.clear();
  for (const ParticleConstraint& c : system_->constraints)
    if (is_inside(c.particle)) filters_.push_back({c.particle, PaddedMat3<Real>(c.free)});
}

template <class Real>
double Product<Real>::multiply(std::span<const PaddedVec3<Real>> p, std::span<PaddedVec3<Real>> q,
                               std::span<double> norms_sq) const {
  const auto sums = rows_.sums([&](std::size_t begin, std::size_t end) {
    PaddedVec3<double> of_product{}, of_norm{};
    for (std::size_t from = begin; from < end; from += kFineGrainSize) {
      const std::size_t to = std::min(from + kFineGrainSize, end);
      if constexpr (std::is_same_v<Real, float>)
        matrix_.multiply(p, q, from, to);
      else
        system_->matrix.multiply(p, q, from, to);
      for (std::size_t i = from; i < to; ++i) of_product += products(p[i], q[i]);
      if (!norm_weights_.empty())
        for (std::size_t i = from; i < to; ++i) of_norm += products(norm_weights_[i] * p[i], p[i]);
    }
    return PaddedVec3<double>{sum_of_first_three(of_product), sum_of_first_three(of_norm), 0, 0};
  });
  double curvature = 0;
  for (std::size_t k = 0; k < selected_.size(); ++k) {
    curvature += sums[k][0];
    norms_sq[k] = sums[k][1];
  }
  for (const ParticleBlock& term : terms_) {
    const PaddedVec3<Real> force = term.block * p[term.particle];
    q[term.particle] += force;
    curvature += sum_of_first_three(products(p[term.particle], force));
  }
  for (const auto& term : stencils_) curvature += term.add_product(p, q);
  for (const auto& term : wide_stencils_) curvature += term.add_product(p, q);
  filter(q);
  return curvature;
}

template <class Real>
Mat3 Product<Real>::sum_of_row(std::size_t row) const {
  if constexpr (std::is_same_v<Real, float>) return matrix_.sum_of_row(row);
  const auto index = static_cast<Index>(row);
  Mat3 sum = Mat3::Zero();
  system_->matrix.for_each_block(index, index + 1, [&](Index, Index, const Mat3& block) { sum += block; });
  return sum;
}

template <class Real>
std::vector<Mat3> Product<Real>::row_sums() const {
  struct Sum {
    Mat3 block = Mat3::Zero();
    Sum& operator+=(const Sum& other) { return block += other.block, *this; }
  };
  std::vector<Mat3> result;
  for (const std::size_t block_index : selected_) {
    const auto first = static_cast<std::size_t>(blocks_[block_index].begin),
               end = static_cast<std::size_t>(blocks_[block_index].end);
    result.push_back(parallel_sum(end - first, kGrainSize, [&](std::size_t begin, std::size_t stop) {
                       Sum sum;
                       for (std::size_t row = first + begin; row < first + stop; ++row) sum.block += sum_of_row(row);
                       return sum;
                     }).block);
  }
  return result;
}

template <class Real>
void Product<Real>::filter(std::span<PaddedVec3<Real>> b) const {
  for (const ParticleBlock& c : filters_) b[c.particle] = c.block * b[c.particle];
}

template class Product<float>;
template class Product<double>;

}  // namespace weft::solver
