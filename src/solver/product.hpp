// What conjugate gradients multiply with: the matrix and the terms of a system, in double or in single precision.
#pragma once

#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// A block matrix in single precision, half the memory to read: y_i = D_i x_i + Σ_j A_ij (x_j − x_i). The sum D_i of a
/// row's blocks is made in double. So stiffness is rounded where particles move against each other, while what moves
/// them together, their mass, is not lost beside it.
class DifferenceMatrix {
 public:
  void take_pattern(const BlockMatrix& matrix);
  /// Takes over the rows [begin, end).
  void take_rows(const BlockMatrix& matrix, std::size_t begin, std::size_t end);
  void multiply(std::span<const Quad<float>> x, std::span<Quad<float>> y, std::size_t begin, std::size_t end) const;
  /// D_i.
  Mat3 sum_of_row(std::size_t row) const;

 private:
  BlockMatrix::Pattern full_, isotropic_;  // without the diagonal
  /// Of a block, column by column, eight numbers that load at once, and the ninth.
  using Octet = float __attribute__((vector_size(32)));
  std::vector<Octet> octets_;  // of full blocks
  std::vector<float> ninths_;
  std::vector<Octet> octets_of_sum_;  // D_i of a row
  std::vector<float> ninths_of_sum_;
  std::vector<float> scalars_;
};

/// S A, A being the matrix with all terms.
template <class Real>
class Product {
 public:
  /// Reads the system, which must outlive the calls that follow.
  void prepare(const LinearSystem& system);

  /// Products from here on are for vectors that are zero outside of these parts.
  void select(std::span<const std::size_t> parts);

  /// q = S A p on the rows of the selected parts; returns p·q, and Σ metric ‖p‖² of each part goes into `moved`, in
  /// their order. p obeys the constraints.
  double multiply(std::span<const Quad<Real>> p, std::span<Quad<Real>> q, std::span<double> moved) const;

  /// Of each selected part, the sum of all blocks of the matrix, terms and constraints apart.
  std::vector<Mat3> row_sums() const;

  /// S b in place, on the rows of the selected parts.
  void filter(std::span<Quad<Real>> b) const;

 private:
  template <std::size_t N>
  struct Stencil {
    std::array<Index, N> particles;
    std::array<Real, N> weights;
    QuadBlock<Real> stiffness;

    /// Adds its product with p to q, and returns what it adds to p·q.
    double add_product(std::span<const Quad<Real>> p, std::span<Quad<Real>> q) const {
      Quad<Real> together = weights[0] * p[particles[0]];
      for (std::size_t k = 1; k < N; ++k) together += weights[k] * p[particles[k]];
      const Quad<Real> force = stiffness * together;
      for (std::size_t k = 0; k < N; ++k) q[particles[k]] += weights[k] * force;
      return sum_of_three(products(together, force));
    }
  };
  struct OfParticle {
    Index particle;
    QuadBlock<Real> block;
  };
  void read_matrix(bool anew);
  template <class Term, std::size_t N, class IsInside>
  static void add_stencil(const Term& term, const IsInside& is_inside, std::vector<Stencil<N>>& stencils);
  Mat3 sum_of_row(std::size_t row) const;

  const LinearSystem* system_ = nullptr;
  std::vector<Part> parts_;  // as the matrix was read
  DifferenceMatrix matrix_;  // in single precision
  std::vector<Real> metric_;
  std::vector<std::size_t> selected_;
  RowChunks rows_;                           // of the selected parts
  std::vector<Stencil<4>> stencils_;         // of the selected parts
  std::vector<Stencil<8>> wide_stencils_;    // likewise
  std::vector<OfParticle> terms_, filters_;  // likewise
};

extern template class Product<float>;
extern template class Product<double>;

}  // namespace weft::solver
