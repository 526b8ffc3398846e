// The compared solvers: preconditioners of conjugate gradients, and direct factorisations.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "bench/solver/systems.hpp"

namespace weft::bench {

/// A preconditioner or factorisation P. apply() computes z = P⁻¹ r. r must satisfy the constraints; z then satisfies
/// them too.
class Inverse {
 public:
  virtual ~Inverse() = default;
  /// Prepares everything that depends only on the pattern of the matrix and can be reused in later steps.
  virtual void analyse(const SheetSystem&) {}
  virtual void factorise(const SheetSystem& sheet) = 0;
  virtual void apply(std::span<const Vec3> r, std::span<Vec3> z) = 0;
};

std::unique_ptr<Inverse> block_jacobi();
/// The program's preconditioner, in double precision.
std::unique_ptr<Inverse> additive_multilevel();
/// Block IC(0): the factor has the pattern of the matrix.
std::unique_ptr<Inverse> incomplete_cholesky();
/// One V-cycle; coarse grids have every second particle, with bilinear interpolation.
std::unique_ptr<Inverse> geometric_multigrid();
/// One V-cycle of smoothed aggregation. `functions`: 3 for translations of aggregates, 6 for rotations as well.
std::unique_ptr<Inverse> aggregation_multigrid(int functions);
std::unique_ptr<Inverse> cholmod();

}  // namespace weft::bench
