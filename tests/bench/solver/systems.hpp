// Linear systems of implicit Euler as the program builds them, on folded sheets of any size.
#pragma once

#include <vector>

#include "solver/linear_system.hpp"

namespace weft::bench {

struct SheetSystem {
  solver::LinearSystem system;
  std::vector<Vec3> b;  ///< [N], obeys the constraints
  std::vector<Vec3> x;  ///< where it is linearised [m]
  int side = 0;         ///< particles along each side
};

enum class Pose {
  hanging,  ///< from two corners
  lying,    ///< folds on a floor and against each other: contacts, nothing held
};

/// A sheet of cotton, 1 m × 1 m, of side × side particles and the stiffness of its threads [N/m], 10 ms a step,
/// laid in folds of 17 cm, stretched along the warp by its own weight.
SheetSystem sheet_system(int side, double stiffness, Pose pose);

/// q = S (A + terms) p, with S the constraints of the system.
void multiply(const solver::LinearSystem& system, std::span<const Vec3> p, std::span<Vec3> q);

}  // namespace weft::bench
