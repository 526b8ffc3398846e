// Additive multilevel preconditioner: particles, aggregates of particles, and the coarsest aggregates solved together.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/solver/linear_system.hpp"
#include "physics/solver/padded_vec3.hpp"
#include "physics/solver/weights.hpp"

namespace weft::solver {

/// Whether prepare() computes the sums over aggregates from the current matrix (in diagonal blocks
/// whose version has changed), or reuses those of an earlier matrix. If the constraints, the system
/// object or the use of interpolation have changed, prepare() computes all sums in either case.
/// Particle blocks and contact terms (StencilTerm, WideTerm, DiagonalTerm) are current in either
/// case.
enum class AggregateSums { recompute, reuse };

/// P⁻¹ = S Σ_l T_l A_l⁻¹ T_lᵀ S, where T_l interpolates from level l to particles and S is the projection on the free
/// directions. T_0 is the identity, and A_0 the diagonal of 3×3 blocks of S A S + (I − S) (prefiltered, Tamstorf, Jones
/// & McCormick, "Smoothed Aggregation Multigrid for Cloth Simulation", 2015). Each further level reduces errors whose
/// wavelength is about the width of its aggregates (Bramble, Pasciak & Xu, "Parallel Multilevel Preconditioners",
/// 1990). T_l = Q_1 Q_2 … Q_l. Q_k interpolates from the aggregates of level k to their members (aggregates of level k
/// − 1, or particles): each member gets a weighted mean of the values of its own aggregate and of the aggregates of its
/// neighbours. Q_k is one step of damped Jacobi on the graph of the matrix, applied to piecewise constant interpolation
/// (smoothed aggregation: Vaněk, Mandel & Brezina, 1996).
///
/// Ideally A_l is the diagonal of 3×3 blocks of T_lᵀ A T_l, or on the last level all of T_lᵀ A T_l. Both are expensive,
/// so A_l is built from R_l A R_lᵀ, where R_l sums over each aggregate. R_l A R_lᵀ is the stiffness against motion of
/// aggregates as wholes, with all strain at their boundaries. Interpolated motion has its strain over the whole width
/// of the aggregates. This width doubles per level, and a displacement that is spread over twice the width has half of
/// the stiffness. Therefore the stiffness (the matrix without its mass part, `norm_weights`) enters A_l with the factor
/// 1/2 per level (1 in a DiagonalBlock that is_small), and the mass part with the factor 1. Contact
/// terms are not part of the matrix. The stiffness of contact terms at each particle is added to
/// the aggregates from which the particle interpolates, with the weights of this interpolation; the
/// sum is an upper bound of the contact part of the diagonal of T_lᵀ A T_l. The last level contains
/// T_lᵀ A T_l of the contact terms exactly.
///
/// If the trace of any particle's 3×3 block exceeds `Numerics::Linear::stiff_particle` times the
/// sum of `norm_weights` over its DiagonalBlock (not tested in a block that is_small, or without
/// `norm_weights`), threads count as very stiff and no level interpolates: T_l = R_lᵀ, and the
/// factor per level is 1. Interpolated motion would stretch threads inside of aggregates where
/// cloth is folded, and R_l A R_lᵀ contains only the threads that cross the boundaries of
/// aggregates.
///
/// prepare() computes in double precision, apply() in the precision `Real`.
template <class Real>
class Preconditioner {
 public:
  /// Reads `system`, which must outlive the following calls. Recomputes only what has changed since the last call.
  void prepare(const LinearSystem& system, AggregateSums sums = AggregateSums::recompute);

  /// z = P⁻¹ r on the rows of these diagonal blocks of the system, as if r were zero on all others. r must obey the
  /// constraints; z then does too.
  void apply(std::span<const PaddedVec3<Real>> r, std::span<PaddedVec3<Real>> z, std::span<const std::size_t> blocks);

 private:
  struct Level {
    std::vector<Index> aggregate_of;        // per particle
    std::vector<Index> parent;              // per aggregate: its aggregate on the coarser level
    Weights<Real> interpolation;            // per member (a particle, or an aggregate of the finer level)
    Weights<Real> restriction;              // per aggregate: its members
    std::vector<RowRange> of_block;         // aggregates of each diagonal block
    RowChunks chunks;                       // of aggregates, in the selected blocks
    std::vector<Mat3> of_matrix;            // per aggregate: scaled stiffness and mass part, no contact terms
    std::vector<char> has_terms;            // per aggregate: its `inverse` contains contact terms
    std::vector<PaddedMat3<Real>> inverse;  // per aggregate, with contact terms
    std::vector<PaddedVec3<Real>> residual, correction;  // per aggregate
  };
  bool has_stiff_threads() const;
  void allocate_levels();
  void compute_weights();
  void find_common_levels();
  void sum_aggregate_blocks(std::size_t index);
  void scale_sums(std::size_t index);
  void mark_particles_with_terms();
  void invert_particles();
  /// A 3×3 block for each particle on which contact terms act.
  struct BlocksWithTerms {
    std::vector<Index> place;  // per particle, −1 for none
    std::vector<Mat3> blocks;
    Mat3& of(Index i) { return blocks[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])]; }
    const Mat3& of(Index i) const { return blocks[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])]; }
  };
  BlocksWithTerms make_blocks_with_terms() const;
  BlocksWithTerms lump_terms() const;
  void invert_aggregates();
  void factorise_coarsest();
  void select(std::span<const std::size_t> blocks);
  void restrict_residual(std::span<const PaddedVec3<Real>> r);
  void correct_aggregates();
  bool is_free(Index i) const { return constraint_of_[i] < 0; }
  Mat3 own_block(Index i) const { return system_->matrix.block(system_->matrix.diagonal(i)); }
  Mat3 filtered(Index i, const Mat3& block, Index j) const;

  const LinearSystem* system_ = nullptr;
  bool interpolates_ = true;                       // false if threads are very stiff
  std::vector<DiagonalBlock> blocks_;              // at the last call of prepare()
  std::vector<std::uint64_t> summed_version_;      // version of each diagonal block when its sums were computed
  std::vector<char> rows_changed_, sums_changed_;  // per diagonal block: whether its rows, or its sums, are new
  std::vector<ParticleConstraint> constraints_;    // at the last call of prepare()
  std::vector<Index> constraint_of_;               // per particle, −1 for none
  struct Filter {
    Index particle;
    PaddedMat3<Real> free;
  };
  std::vector<std::vector<Filter>> filters_;  // per diagonal block
  std::vector<char> has_terms_, had_terms_;   // per particle: contact terms act on it
  std::vector<PaddedMat3<Real>> inverse_;     // per particle: S A_0⁻¹ S
  std::vector<Level> levels_;                 // the last one is the coarsest
  Weights<Real> coarse_weights_;              // per particle, from the coarsest aggregates
  // Per 3×3 block of the matrix: first level on which one aggregate contains its row and its column; the number of
  // levels if there is none.
  std::vector<std::uint8_t> common_level_full_, common_level_isotropic_;
  std::vector<std::vector<Index>> members_of_coarse_;  // per coarsest aggregate: its particles
  std::vector<std::size_t> selected_;                  // diagonal blocks of the last apply()
  RowChunks rows_;                                     // their rows
  Eigen::MatrixXd coarse_matrix_without_terms_, coarse_matrix_;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> coarse_factor_;
  Eigen::Vector<Real, Eigen::Dynamic> coarse_vector_;
};

extern template class Preconditioner<float>;
extern template class Preconditioner<double>;

}  // namespace weft::solver
