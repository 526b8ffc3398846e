// Product of a system's matrix and terms with a vector, in double or in single precision.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/solver/linear_system.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// A block matrix A in single precision, which takes half of the memory of double precision. Its
/// product is y_i = D_i x_i + Σ_j A_ij (x_j − x_i), where the sum D_i of a row's blocks is computed
/// in double. Thus the rounding errors of A_ij act only on relative motion, and do not hide the
/// much smaller mass part.
class DifferenceMatrix {
 public:
  void copy_pattern(const BlockMatrix& matrix);
  /// Copies the rows [begin, end).
  void copy_rows(const BlockMatrix& matrix, std::size_t begin, std::size_t end);
  /// y = A x on the rows [begin, end).
  void multiply(std::span<const PaddedVec3<float>> x, std::span<PaddedVec3<float>> y, std::size_t begin,
                std::size_t end) const;
  /// D_i for i = `row`
  Mat3 sum_of_row(std::size_t row) const;

 private:
  std::shared_ptr<const BlockMatrix::Layout> layout_;
  BlockMatrix::Pattern full_;  // without the diagonal
  /// The first eight numbers of a block, column by column, for one vector register; `ninths_` hold the last numbers.
  using Octet = float __attribute__((vector_size(32)));
  std::vector<Octet> octets_;  // of full blocks off the diagonal
  std::vector<float> ninths_;
  std::vector<Octet> octets_of_sum_;  // D_i of each row
  std::vector<float> ninths_of_sum_;
  std::vector<float> scalars_;  // of isotropic blocks
};

/// The product q = S A p, where A is the matrix with all terms but outer products (RankOneTerm), and S is the
/// projection on the free directions.
template <class Real>
class Product {
 public:
  /// Reads `system`, which must outlive the following calls.
  void prepare(const LinearSystem& system);

  /// Restricts the following products to vectors that are zero outside of these diagonal blocks.
  void select(std::span<const std::size_t> blocks);

  /// q = S A p on the rows of the selected blocks; returns p·q. Writes Σ norm_weights ‖p‖² of each selected block, in
  /// the order of select(), into `norms_sq` (0 without `norm_weights`). p must obey the constraints.
  double multiply(std::span<const PaddedVec3<Real>> p, std::span<PaddedVec3<Real>> q, std::span<double> norms_sq) const;

  /// Per selected diagonal block: the sum of all its 3×3 blocks, without terms and constraints.
  std::vector<Mat3> row_sums() const;

  /// b = S b, on the rows of the selected blocks.
  void filter(std::span<PaddedVec3<Real>> b) const;

 private:
  template <std::size_t N>
  struct Stencil {
    std::array<Index, N> particles;
    std::array<Real, N> weights;
    PaddedMat3<Real> stiffness;

    /// Adds the term's product with p to q; returns the increase of p·q.
    double add_product(std::span<const PaddedVec3<Real>> p, std::span<PaddedVec3<Real>> q) const {
      PaddedVec3<Real> combined = weights[0] * p[particles[0]];
      for (std::size_t k = 1; k < N; ++k) combined += weights[k] * p[particles[k]];
      const PaddedVec3<Real> force = stiffness * combined;
      for (std::size_t k = 0; k < N; ++k) q[particles[k]] += weights[k] * force;
      return sum_of_first_three(products(combined, force));
    }
  };
  struct ParticleBlock {
    Index particle;
    PaddedMat3<Real> block;
  };
  template <class Term, std::size_t N, class IsInside>
  static void add_stencil(const Term& term, const IsInside& is_inside, std::vector<Stencil<N>>& stencils);
  Mat3 sum_of_row(std::size_t row) const;

  const LinearSystem* system_ = nullptr;
  std::vector<DiagonalBlock> blocks_;  // at the last prepare()
  DifferenceMatrix matrix_;            // used in single precision only
  std::vector<Real> norm_weights_;
  std::vector<std::size_t> selected_;
  RowChunks rows_;  // of the selected blocks
  std::vector<Stencil<4>> stencils_;
  std::vector<Stencil<8>> wide_stencils_;
  std::vector<ParticleBlock> terms_, filters_;  // of DiagonalTerms, and of constraints
};

extern template class Product<float>;
extern template class Product<double>;

}  // namespace weft::solver
