// The recurrence of conjugate gradients, in double or in single precision.
#pragma once

#include <span>
#include <vector>

#include "physics/solver/block_motions.hpp"
#include "physics/solver/linear_system.hpp"
#include "physics/solver/preconditioner.hpp"
#include "physics/solver/product.hpp"
#include "physics/solver/rank_one.hpp"
#include "physics/solver/row_chunks.hpp"

namespace weft::solver {

/// Smallest LinearGoal::relative for which solves use single precision: five times the relative error that rounding can
/// leave in the energy norm, 6e-8 √kMaxSingleStiffness.
inline constexpr double kSmallestSingleGoal = 1e-3;

/// Allowed error of the solution, per diagonal block. One of two bounds suffices: the error in the energy norm is at
/// most `relative` times the norm of the solution without its step along Directions::start, or the error in the
/// mass-weighted norm (without `norm_weights`, the energy norm) is at most `absolute`.
struct LinearGoal {
  double relative = 0;
  std::span<const double> absolute = {};  ///< per diagonal block; empty: none
};

/// Known directions of the solution; each may be empty.
struct Directions {
  /// The first step of a solve is along this direction, of the length that is best in the energy
  /// norm. This step costs one product with the matrix.
  std::span<const Vec3> start = {};
  /// Motion to which the caller adds the solution. At the end of a solve with at least one
  /// iteration and without End::indefinite, the residual does no work along the sum of motion and
  /// solution, and the residual sums to zero over each diagonal block without constraints
  /// (Galerkin's condition for these directions of each diagonal block).
  std::span<const Vec3> motion = {};
  /// Second motion along which the residual does no work at the end; ignored without `motion`.
  std::span<const Vec3> drift = {};
};

/// State of a solve, in either precision.
struct Progress {
  /// Error data of one diagonal block.
  struct BlockProgress {
    double energy = 0;  ///< ‖x‖²_A of the solution x without its step along Directions::start
    /// Per iteration: decrease of ‖e‖²_A, and the squared mass-weighted norm of the step / this decrease, at most 1.
    std::vector<double> gains, norm_ratios;
    double error_energy() const;      ///< estimate of ‖e‖²_A, where e is the error
    double error_norm_ratio() const;  ///< largest of the recent `norm_ratios`

   private:
    std::ptrdiff_t count_recent() const;
  };
  std::vector<BlockProgress> blocks;  ///< all diagonal blocks of the system
  int iterations = 0;
  bool is_exact = false;  ///< the residual is zero up to rounding

  /// Whether the estimated errors of the selected diagonal blocks are within `goal`.
  bool meets(const LinearGoal& goal, std::span<const std::size_t> selected) const;
};

/// Why the iteration ended.
enum class End {
  converged,
  out_of_iterations,
  indefinite,    ///< the matrix has a direction without positive curvature
  needs_double,  ///< single precision only: the caller must continue in double, with a new search direction
};

/// The iteration of ConjugateGradient, in the precision `Real`.
template <class Real>
class Recurrence {
 public:
  /// Reads `system`, which must outlive the following calls.
  void prepare(const LinearSystem& system, AggregateSums sums);

  /// Returns P⁻¹ b. `all_blocks`: the indices of all diagonal blocks. Valid until the next call.
  std::span<const PaddedVec3<Real>> precondition(std::span<const Vec3> b, std::span<const std::size_t> all_blocks);

  /// Solves A x = b on these diagonal blocks; the particles of all others count as held. At the call, x must be zero
  /// or, if `progress` already has iterations, the result of these iterations.
  End solve(std::span<const Vec3> b, const LinearGoal& goal, int max_iterations, std::span<Vec3> x,
            const Directions& directions, std::span<const std::size_t> blocks, Progress& progress);

  /// b − A x of the last solve, on the rows that it solved for.
  std::span<const PaddedVec3<Real>> residual() const { return r_; }

 private:
  void begin(std::span<const Vec3> b, std::span<const Vec3> x, std::span<const Vec3> start, Progress& progress);
  void step_along_start(std::span<const Vec3> start);
  End iterate(const LinearGoal& goal, int max_iterations, Progress& progress);
  double multiply() {
    const double curvature = product_.multiply(p_, q_, norms_sq_);
    return curvature + rank_one_.multiply(p_, q_);
  }
  void precondition_rank_one();
  void advance(double alpha, Progress& progress);
  double apply_preconditioner(std::span<PaddedVec3<Real>> z);
  void balance(const Directions& directions, std::span<Vec3> x);
  std::vector<double> dots(std::span<const PaddedVec3<Real>> a, std::span<const PaddedVec3<Real>> b) const;
  std::vector<AlongMotions> along_motions(std::span<const PaddedVec3<Real>> v, bool has_second) const;

  const LinearSystem* system_ = nullptr;
  std::vector<DiagonalBlock> blocks_;
  std::vector<std::size_t> selected_;
  RowChunks rows_;  // of the selected blocks
  Product<Real> product_;
  Preconditioner<Real> preconditioner_;
  RankOneTerms<Real> rank_one_;
  BlockMotions block_motions_;
  std::vector<PaddedVec3<Real>> x_, r_, z_, p_, q_;
  std::vector<Vec3> start_;            // filtered by the constraints
  double start_multiple_ = 0;          // the solution is x_ plus this multiple of start_
  double start_gain_ = 0;              // decrease of ‖e‖²_A by the step along start_
  std::vector<double> norms_sq_, rz_;  // per selected block: Σ norm_weights ‖p‖², r·z
};

extern template class Recurrence<float>;
extern template class Recurrence<double>;

}  // namespace weft::solver
