// Additive multilevel preconditioner: particles, groups of particles, and patches solved together.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/linear_system.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// P⁻¹ = Σ_l R_lᵀ A_l⁻¹ R_l on the free directions: R_l sums over the groups of level l (of a single particle first),
/// A_l is the diagonal of 3×3 blocks of R_l A R_lᵀ, and on the last level all of that matrix. Each level sees motion
/// about as long as its groups are wide (additive Schwarz with piecewise constant coarse spaces; Bramble, Pasciak & Xu,
/// "Parallel Multilevel Preconditioners", 1990). Constraints are applied before preconditioning: blocks are those of
/// S A S + (I − S) (prefiltering, Tamstorf, Jones & McCormick, "Smoothed Aggregation Multigrid for Cloth Simulation",
/// 2015). It is set up in double and applied in `Real`.
template <class Real>
class Preconditioner {
 public:
  /// Reads the system, which must outlive the calls that follow. What has not changed since the last time is kept.
  void prepare(const LinearSystem& system);

  /// z = P⁻¹ r on the rows of these parts, as if r were zero on the others. r obeys the constraints, and so does z.
  void apply(std::span<const Quad<Real>> r, std::span<Quad<Real>> z, std::span<const std::size_t> parts);

 private:
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  /// Groups between single particles and patches.
  struct Level {
    std::vector<Index> group_of;           // per particle
    std::vector<Index> parent;             // per group, on the next level
    std::vector<Index> start, members;     // of each group, on the level before; members of g from start[g] on
    std::vector<Range> of_part;            // groups of each part
    std::vector<Mat3> of_matrix;           // per group, without terms
    std::vector<char> touched;             // per group: by terms, when `inverse` was made
    std::vector<QuadBlock<Real>> inverse;  // with them
    std::vector<Quad<Real>> residual, correction;
  };
  void prepare_levels();
  void find_shared_levels();
  void sum_blocks(std::size_t part);
  void mark_touched();
  void invert_particles();
  void invert_groups();
  void factorise_patches();
  template <class Body>
  void for_each_term(const Body& body) const;
  void restrict_residual(std::span<const Quad<Real>> r, std::span<const std::size_t> parts);
  void correct_groups(std::span<const std::size_t> parts);
  bool is_free(Index i) const { return constraint_of_[i] < 0; }
  Mat3 filtered(Index i, const Mat3& block, Index j) const;

  const LinearSystem* system_ = nullptr;
  std::vector<Part> parts_;                      // as the sums were made
  std::vector<char> changed_;                    // per part, since then
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
  // Per block of the matrix the first level on which row and column are in the same group, or the number of levels.
  std::vector<std::uint8_t> shared_full_, shared_isotropic_;
  Eigen::MatrixXd patches_of_matrix_, patch_matrix_;
  Eigen::LLT<Eigen::MatrixXd> patch_solver_;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> patch_factor_;
  Eigen::Vector<Real, Eigen::Dynamic> patch_vector_;
};

extern template class Preconditioner<float>;
extern template class Preconditioner<double>;

}  // namespace weft::solver
