#include "physics/solver/rank_one.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "physics/solver/row_chunks.hpp"

namespace weft::solver {

template <class Real>
void RankOneTerms<Real>::prepare(const LinearSystem& system) {
  terms_.clear();
  rows_ = static_cast<std::size_t>(system.matrix.rows());
  const std::vector<DiagonalBlock> blocks = blocks_of(system);
  for (const RankOneTerm& of_system : system.rank_one_terms) {
    Term& term = terms_.emplace_back();
    term.begin = static_cast<std::size_t>(of_system.begin);
    term.block_index = block_of_row(blocks, of_system.begin);
    term.stiffness = of_system.stiffness;
    for (const Vec3& d : of_system.direction) term.direction.push_back(padded<Real>(d));
    for (const ParticleConstraint& c : system.constraints) {
      const auto row = static_cast<std::size_t>(c.particle);
      if (row < term.begin || row - term.begin >= term.direction.size()) continue;
      term.direction[row - term.begin] = padded<Real>(c.free * of_system.direction[row - term.begin]);
    }
  }
}

template <class Real>
void RankOneTerms<Real>::select(std::span<const std::size_t> blocks) {
  for (Term& term : terms_) term.is_selected = std::ranges::count(blocks, term.block_index) > 0;
}

template <class Real>
void RankOneTerms<Real>::prepare_inverses(const Apply& apply) {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    Term& term = terms_[t];
    if (!term.is_selected) continue;
    std::vector<PaddedVec3<Real>> direction(rows_);
    std::ranges::copy(term.direction, direction.begin() + static_cast<std::ptrdiff_t>(term.begin));
    term.inverse.assign(rows_, PaddedVec3<Real>{});
    apply(direction, term.inverse);
    correct(term.inverse, t);
    term.factor = term.stiffness / (1 + term.stiffness * dot(term, term.inverse));
  }
}

// d · v
template <class Real>
double RankOneTerms<Real>::dot(const Term& term, std::span<const PaddedVec3<Real>> v) {
  return parallel_sum(term.direction.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    PaddedVec3<double> sum{};
    for (std::size_t i = begin; i < end; ++i) sum += products(term.direction[i], v[term.begin + i]);
    return sum_of_first_three(sum);
  });
}

template <class Real>
double RankOneTerms<Real>::multiply(std::span<const PaddedVec3<Real>> p, std::span<PaddedVec3<Real>> q) const {
  double curvature = 0;
  for (const Term& term : terms_) {
    if (!term.is_selected) continue;
    const double along = dot(term, p);
    const Real factor = static_cast<Real>(term.stiffness * along);
    parallel_for(term.direction.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) q[term.begin + i] += factor * term.direction[i];
    });
    curvature += term.stiffness * along * along;
  }
  return curvature;
}

template <class Real>
void RankOneTerms<Real>::correct(std::span<PaddedVec3<Real>> z) const {
  correct(z, terms_.size());
}

// Corrects for the first `terms` terms only.
template <class Real>
void RankOneTerms<Real>::correct(std::span<PaddedVec3<Real>> z, std::size_t terms) const {
  for (std::size_t t = 0; t < terms; ++t) {
    const Term& term = terms_[t];
    if (!term.is_selected) continue;
    const Real factor = static_cast<Real>(term.factor * dot(term, z));
    parallel_for(rows_, kGrainSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) z[i] -= factor * term.inverse[i];
    });
  }
}

template class RankOneTerms<float>;
template class RankOneTerms<double>;

}  // namespace weft::solver
