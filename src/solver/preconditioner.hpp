// Additive multilevel preconditioner: particles, groups of particles, and patches solved together.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"
#include "solver/weights.hpp"

namespace weft::solver {

/// Whether sums over groups are made of the matrix as it is, or may be those of the same constraints and an earlier
/// matrix. Particles have their blocks, and terms are seen, either way.
enum class Sums { anew, kept };

/// P⁻¹ = S Σ_l P_l A_l⁻¹ P_lᵀ S, S the projection on the free directions. P_0 is the identity, A_0 the diagonal of 3×3
/// blocks of A, prefiltered: of S A S + (I − S) (Tamstorf, Jones & McCormick, "Smoothed Aggregation Multigrid for Cloth
/// Simulation", 2015). Each further level sees motion about as long as its groups are wide (Bramble, Pasciak & Xu,
/// "Parallel Multilevel Preconditioners", 1990): P_l interpolates from groups, P_l = Q_1 Q_2 … Q_l, where Q_k takes to
/// each member of a group the average of the groups that it and its neighbours are in, as a step of damped Jacobi on
/// the graph of the matrix makes it of constants (smoothed aggregation: Vaněk, Mandel & Brezina, 1996).
///
/// A_l should be the diagonal of P_lᵀ A P_l, and on the last level all of it. That is dear, and known well enough from
/// sums over groups, R_l A R_lᵀ: where groups move as wholes all strain is in the seams between them, and where it is
/// spread over the width of a group there is half as much of it, each time that the width doubles. Of the matrix but
/// its metric a share of 1/2^l is taken, of the metric all. Terms know no neighbours: what they hold particles with is
/// taken to groups by the weights of interpolation, which is no less than P_lᵀ A P_l has on its diagonal, and for
/// patches that itself is made.
///
/// Threads far stiffer than mass stay constant on groups, P_l = R_lᵀ with all of the sums: interpolation bends folds,
/// and then sums over seams say nothing of threads that run elsewhere within groups.
///
/// It is set up in double and applied in `Real`.
template <class Real>
class Preconditioner {
 public:
  /// Reads the system, which must outlive the calls that follow. What has not changed since the last time is kept.
  void prepare(const LinearSystem& system, Sums sums = Sums::anew);

  /// z = P⁻¹ r on the rows of these parts, as if r were zero on the others. r obeys the constraints, and so does z.
  void apply(std::span<const Quad<Real>> r, std::span<Quad<Real>> z, std::span<const std::size_t> parts);

 private:
  /// Groups between single particles and patches.
  struct Level {
    std::vector<Index> group_of;           // per particle
    std::vector<Index> parent;             // per group, on the next level
    Weights<Real> of_groups;               // per member (a particle, a group of the level before)
    Weights<Real> of_members;              // per group
    std::vector<RowRange> of_part;         // groups of each part
    RowChunks groups;                      // of the selected parts
    std::vector<Mat3> of_matrix;           // per group, without terms
    std::vector<char> touched;             // per group: by terms, when `inverse` was made
    std::vector<QuadBlock<Real>> inverse;  // with them
    std::vector<Quad<Real>> residual, correction;
  };
  bool is_stiff() const;
  void prepare_levels();
  void find_weights();
  void find_shared_levels();
  void sum_blocks(std::size_t part);
  void scale_sums(std::size_t part);
  void mark_touched();
  void invert_particles();
  /// A block of each particle that terms act on.
  struct TouchedBlocks {
    std::vector<Index> place;  // per particle, −1 for none
    std::vector<Mat3> blocks;
    Mat3& of(Index i) { return blocks[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])]; }
    const Mat3& of(Index i) const { return blocks[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])]; }
  };
  TouchedBlocks touched_blocks() const;
  TouchedBlocks lumped_terms() const;
  void invert_groups();
  void factorise_patches();
  void select(std::span<const std::size_t> parts);
  void restrict_residual(std::span<const Quad<Real>> r);
  void correct_groups();
  bool is_free(Index i) const { return constraint_of_[i] < 0; }
  Mat3 own_block(Index i) const { return system_->matrix.block(system_->matrix.diagonal(i)); }
  Mat3 filtered(Index i, const Mat3& block, Index j) const;

  const LinearSystem* system_ = nullptr;
  bool smooth_ = true;                           // levels interpolate
  std::vector<Part> parts_;                      // as the sums were made
  std::vector<std::uint64_t> summed_;            // per part, its version then
  std::vector<char> changed_, sums_changed_;     // per part: its rows, its sums over groups
  std::vector<ParticleConstraint> constraints_;  // as the sums were made
  std::vector<Index> constraint_of_;             // per particle, −1 for none
  struct Filter {
    Index particle;
    QuadBlock<Real> free;
  };
  std::vector<std::vector<Filter>> filters_;    // per part
  std::vector<char> touched_, touched_before_;  // per particle: by terms
  std::vector<QuadBlock<Real>> inverse_;        // per particle, already filtered: S P⁻¹ S
  std::vector<Level> levels_;                   // the last one is that of the patches
  Weights<Real> of_patches_;                    // per particle
  // Per block of the matrix the first level on which row and column are in the same group, or the number of levels.
  std::vector<std::uint8_t> shared_full_, shared_isotropic_;
  std::vector<std::vector<Index>> members_of_patch_;  // particles
  std::vector<std::size_t> selected_;                 // parts that were applied to last
  RowChunks rows_;                                    // of them
  Eigen::MatrixXd patches_of_matrix_, patch_matrix_;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> patch_factor_;
  Eigen::Vector<Real, Eigen::Dynamic> patch_vector_;
};

extern template class Preconditioner<float>;
extern template class Preconditioner<double>;

}  // namespace weft::solver
