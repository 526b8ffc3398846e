// Linear systems of implicit Euler, as the program builds them, for folded sheets of any size.
#pragma once

#include <vector>

#include "physics/solver/linear_system.hpp"

namespace weft::bench {

struct SheetSystem {
  solver::LinearSystem system;
  std::vector<Vec3> b;  ///< [N], satisfies the constraints
  std::vector<Vec3> x;  ///< positions of the linearisation [m]
  int side = 0;         ///< particles along each side
};

enum class Pose {
  hanging,  ///< hangs from two corners
  lying,    ///< lies in folds on a floor and touches itself; no particle is held
};

/// Makes the system of a step of 10 ms for a cotton sheet of 1 m × 1 m with side × side particles, in folds of 17 cm
/// and stretched along the warp by its own weight. `stiffness`: of the threads [N/m].
SheetSystem sheet_system(int side, double stiffness, Pose pose);

/// q = S (A + terms) p. S: projection on the directions that the constraints leave free.
void multiply(const solver::LinearSystem& system, std::span<const Vec3> p, std::span<Vec3> q);

}  // namespace weft::bench
