#include "solver/coarse_terms.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/parallel_append.hpp"
#include "solver/term_rows.hpp"

namespace weft::solver {
namespace {

struct CoarseWeight {
  Index aggregate;
  double weight;
};

// Products rowsᵀ ⊗ stiffness ⊗ columns of lists of weights.
struct CoarseTerms {
  struct Product {
    std::size_t rows, columns, end;  // weights of rows from `rows` on, of columns from `columns` on; the same if empty
    Mat3 stiffness;
  };
  std::vector<CoarseWeight> weights;
  std::vector<Product> products;

  std::span<const CoarseWeight> rows(const Product& of) const {
    return std::span(weights).subspan(of.rows, of.columns - of.rows);
  }
  std::span<const CoarseWeight> columns(const Product& of) const {
    return of.columns == of.end ? rows(of) : std::span(weights).subspan(of.columns, of.end - of.columns);
  }
};

void append(CoarseTerms& to, const CoarseTerms& more) {
  const std::size_t before = to.weights.size();
  weft::append(to.weights, more.weights);
  for (CoarseTerms::Product product : more.products) {
    product.rows += before, product.columns += before, product.end += before;
    to.products.push_back(product);
  }
}

// Adds the coarsest aggregates from which a particle interpolates to the weights from `first` on.
template <class Real>
void add_weights(const Weights<Real>& interpolation, Index particle, double weight, std::size_t first,
                 std::vector<CoarseWeight>& weights) {
  for (Index s = interpolation.start[particle]; s < interpolation.start[particle + 1]; ++s) {
    const Index aggregate = interpolation.columns[s];
    const auto known = std::find_if(weights.begin() + static_cast<std::ptrdiff_t>(first), weights.end(),
                                    [&](const CoarseWeight& w) { return w.aggregate == aggregate; });
    if (known == weights.end())
      weights.push_back({aggregate, weight * interpolation.values[s]});
    else
      known->weight += weight * interpolation.values[s];
  }
}

// If all particles of a term are free, their weights are added up; if one is constrained, each is filtered by itself.
template <class Real>
void restrict_term(const LinearSystem& system, const Weights<Real>& interpolation, std::span<const Index> constraint_of,
                   const AnyTerm& term, CoarseTerms& list) {
  const std::size_t count = term.particles.size(), first = list.weights.size();
  const auto is_free = [&](Index i) { return constraint_of[static_cast<std::size_t>(i)] < 0; };
  if (std::ranges::all_of(term.particles, is_free)) {
    for (std::size_t k = 0; k < count; ++k)
      if (term.weights[k] != 0) add_weights(interpolation, term.particles[k], term.weights[k], first, list.weights);
    list.products.push_back({first, list.weights.size(), list.weights.size(), term.stiffness});
    return;
  }
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) {
      if (term.weights[a] == 0 || term.weights[b] == 0) continue;
      const Index i = term.particles[a], j = term.particles[b];
      const std::size_t rows = list.weights.size();
      add_weights(interpolation, i, term.weights[a], rows, list.weights);
      const std::size_t columns = list.weights.size();
      add_weights(interpolation, j, term.weights[b], columns, list.weights);
      list.products.push_back(
          {rows, columns, list.weights.size(), filtered(system.constraints, constraint_of, i, term.stiffness, j)});
    }
}

}  // namespace

template <class Real>
void add_terms(const LinearSystem& system, const Weights<Real>& weights, std::span<const Index> constraint_of,
               Eigen::MatrixXd& matrix) {
  CoarseTerms terms;
  parallel_append(term_count(system), kFineGrainSize, terms, [&](std::size_t begin, std::size_t end, auto& list) {
    for (std::size_t t = begin; t < end; ++t) restrict_term(system, weights, constraint_of, term_at(system, t), list);
  });
  struct RowWeight {
    std::size_t product;
    double weight;
  };
  std::vector<std::vector<RowWeight>> of_rows(static_cast<std::size_t>(matrix.rows()) / 3);
  for (std::size_t p = 0; p < terms.products.size(); ++p)
    for (const auto& [g, weight] : terms.rows(terms.products[p]))
      of_rows[static_cast<std::size_t>(g)].push_back({p, weight});
  parallel_for(of_rows.size(), 1, [&](std::size_t row, std::size_t) {
    const auto g = static_cast<Eigen::Index>(row);
    for (const auto& [p, of_g] : of_rows[row])
      for (const auto& [h, of_h] : terms.columns(terms.products[p]))
        if (g >= h) matrix.block<3, 3>(3 * g, 3 * h) += of_g * of_h * terms.products[p].stiffness;
  });
}

template void add_terms(const LinearSystem&, const Weights<float>&, std::span<const Index>, Eigen::MatrixXd&);
template void add_terms(const LinearSystem&, const Weights<double>&, std::span<const Index>, Eigen::MatrixXd&);

}  // namespace weft::solver
