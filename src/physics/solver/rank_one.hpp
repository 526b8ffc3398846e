// Outer products beside a system's matrix (RankOneTerm): their contribution to products and to the preconditioner.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "physics/solver/linear_system.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// Extends a preconditioner P of the matrix without outer products to the whole matrix, by the formula of Sherman and
/// Morrison for one outer product k d dᵀ at a time: (P + k d dᵀ)⁻¹ = P⁻¹ − w wᵀ k / (1 + k d·w) with w = P⁻¹ d. If P is
/// spectrally equivalent to the rest of the matrix, P + k d dᵀ is spectrally equivalent to the whole matrix for any k,
/// with the same constants if these enclose 1.
template <class Real>
class RankOneTerms {
 public:
  using Apply = std::function<void(std::span<const PaddedVec3<Real>> r, std::span<PaddedVec3<Real>> z)>;

  /// Copies the terms of `system`, filtered by its constraints.
  void prepare(const LinearSystem& system);

  /// Restricts the following calls to vectors that are zero outside of these diagonal blocks.
  void select(std::span<const std::size_t> blocks);
  /// Computes w of the selected terms with `apply`, which applies P⁻¹ on the selected diagonal blocks.
  void prepare_inverses(const Apply& apply);

  /// Adds k d dᵀ p of each selected term to q, where d is filtered by the constraints; returns the increase of p·q.
  double multiply(std::span<const PaddedVec3<Real>> p, std::span<PaddedVec3<Real>> q) const;

  /// Changes z from P⁻¹ r to (P + Σ k d dᵀ)⁻¹ r, with the sum over the selected terms. Needs
  /// prepare_inverses().
  void correct(std::span<PaddedVec3<Real>> z) const;

 private:
  struct Term {
    std::size_t begin = 0, block_index = 0;
    double stiffness = 0;
    std::vector<PaddedVec3<Real>> direction;  // filtered by the constraints
    std::vector<PaddedVec3<Real>> inverse;    // w, where P includes the terms before
    double factor = 0;                        // k / (1 + k d·w)
    bool is_selected = false;
  };
  static double dot(const Term& term, std::span<const PaddedVec3<Real>> v);
  void correct(std::span<PaddedVec3<Real>> z, std::size_t terms) const;

  std::size_t rows_ = 0;
  std::vector<Term> terms_;
};

extern template class RankOneTerms<float>;
extern template class RankOneTerms<double>;

}  // namespace weft::solver
