// The solvers that are compared: preconditioners of conjugate gradients, and direct factorisations.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "bench/solver/systems.hpp"

namespace weft::bench {

/// z = P⁻¹ r for r that obeys the constraints, and so does z.
class Inverse {
 public:
  virtual ~Inverse() = default;
  /// What depends on the pattern alone and can be kept from step to step.
  virtual void analyse(const SheetSystem&) {}
  virtual void factorise(const SheetSystem& sheet) = 0;
  virtual void apply(std::span<const Vec3> r, std::span<Vec3> z) = 0;
};

std::unique_ptr<Inverse> block_jacobi();
/// The program's to begin with.
std::unique_ptr<Inverse> additive_multilevel();
/// Block IC(0): the pattern of the matrix.
std::unique_ptr<Inverse> incomplete_cholesky();
/// The program's where more than a tenth is asked for: the additive levels, and its incomplete factor beside.
std::unique_ptr<Inverse> levels_and_factor();
/// One V-cycle; coarse grids of every second particle, bilinear between.
std::unique_ptr<Inverse> geometric_multigrid();
/// One V-cycle of smoothed aggregation; 3: aggregates are translated, 6: they also turn.
std::unique_ptr<Inverse> aggregation_multigrid(int functions);
std::unique_ptr<Inverse> cholmod();

}  // namespace weft::bench
