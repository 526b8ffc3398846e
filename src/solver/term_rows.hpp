// Which terms of a linear system act on which rows, so that threads can add up terms row by row.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"

namespace weft::solver {

/// Rows on which terms act, and for each the terms in ascending order. Terms are numbered as for_each_term() visits
/// them, the diagonal terms before the others. Sums over the terms of a row have the bits of a loop over all terms.
class TermRows {
 public:
  struct Entry {
    Index term;
    Index end;  ///< of the term: its place among the term's particles
  };

  /// Reads the terms of `system` that weigh a particle.
  void assign(const LinearSystem& system);

  /// Sorted.
  std::span<const Index> rows() const { return rows_; }
  /// The terms that act on row rows()[k].
  std::span<const Entry> terms(std::size_t k) const {
    return std::span(entries_).subspan(start_[k], start_[k + 1] - start_[k]);
  }
  /// Calls body(k) for each row of rows(), several threads at a time.
  template <class Body>
  void for_each_row(const Body& body) const {
    parallel_for(rows_.size(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(k);
    });
  }

 private:
  static constexpr std::size_t kRowsAtOnce = 64;

  std::vector<Index> rows_;
  std::vector<std::size_t> start_;  // of each row, then the number of entries
  std::vector<Entry> entries_;
  std::vector<Index> count_;  // scratch, per row of the system
};

/// Number of terms, diagonal ones included.
inline std::size_t term_count(const LinearSystem& system) {
  return system.diagonal_terms.size() + system.terms.size() + system.wide_terms.size();
}

/// A term of any kind.
struct AnyTerm {
  std::span<const Index> particles;
  std::span<const double> weights;
  const Mat3& stiffness;

  /// Sum of the weights of the particles on the side of a particle with this weight.
  double weight_of_side(double weight) const {
    double sum = 0;
    for (const double w : weights)
      if ((w > 0) == (weight > 0)) sum += w;
    return sum;
  }
};

/// The term with this number, as in TermRows.
inline AnyTerm term_at(const LinearSystem& system, std::size_t number) {
  static constexpr double kOne = 1;
  const std::size_t diagonal = system.diagonal_terms.size(), small = diagonal + system.terms.size();
  if (number < diagonal) {
    const DiagonalTerm& term = system.diagonal_terms[number];
    return {{&term.particle, 1}, {&kOne, 1}, term.stiffness};
  }
  if (number < small) {
    const StencilTerm& term = system.terms[number - diagonal];
    return {term.particles, term.weights, term.stiffness};
  }
  const WideTerm& term = system.wide_terms[number - small];
  return {term.particles, term.weights, term.stiffness};
}

}  // namespace weft::solver
