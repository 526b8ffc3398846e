// The terms of a system that are outer products: in its product and in its preconditioner.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// A preconditioner P of the rest of the matrix becomes one of the whole by Sherman and Morrison's formula, term after
/// term: (P + k d dᵀ)⁻¹ = P⁻¹ − w wᵀ k / (1 + k d·w) with w = P⁻¹ d. If P is within bounds of the rest, the sum is
/// within the same bounds of the whole, however large k is.
template <class Real>
class RankOneTerms {
 public:
  using Apply = std::function<void(std::span<const Quad<Real>> r, std::span<Quad<Real>> z)>;

  /// Reads the system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system);

  /// What follows is for vectors that are zero outside of these parts.
  void select(std::span<const std::size_t> parts);
  /// And for the preconditioner of the rest that `apply` applies to these parts.
  void use(const Apply& apply);

  /// Adds k d dᵀ p of each selected term to q, filtered; returns p·q of them.
  double multiply(std::span<const Quad<Real>> p, std::span<Quad<Real>> q) const;

  /// z = P⁻¹ r becomes that of the sum.
  void correct(std::span<Quad<Real>> z) const;

  bool empty() const { return terms_.empty(); }

 private:
  struct Term {
    std::size_t begin = 0, part = 0;
    double stiffness = 0;
    std::vector<Quad<Real>> direction;  // filtered by the constraints
    std::vector<Quad<Real>> inverse;    // w, on all rows
    double factor = 0;                  // k / (1 + k d·w)
    bool is_selected = false;
  };
  static double dot(const Term& term, std::span<const Quad<Real>> v);
  void correct(std::span<Quad<Real>> z, std::size_t terms) const;

  std::size_t rows_ = 0;  // of the system
  std::vector<Term> terms_;
};

extern template class RankOneTerms<float>;
extern template class RankOneTerms<double>;

}  // namespace weft::solver
