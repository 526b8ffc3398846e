// Earlier states that a time integration method refers to.
#pragma once

#include <span>

#include "core/types.hpp"

namespace weft {

/// Positions xₖ at an earlier time, and their weight wₖ in the velocity of a method: v = r (x − Σ wₖ xₖ), where r [1/s]
/// is dv/dx of the method. Likewise, dq/dt of any quantity q(x) is r (q(x) − Σ wₖ q(xₖ)). If q is a length and the body
/// turns rigidly, r (q(x) − Σ wₖ q(xₖ)) is zero, however large the angle per step is; ∂q/∂x v is not zero.
struct EarlierPositions {
  std::span<const Vec3> x;
  double weight = 0;
};

/// Particles at the start of a step, and at the start of the previous step. Positions [m], velocities [m/s].
struct StepStart {
  double h = 0;                ///< length of the step [s]
  std::span<const Vec3> x, v;  ///< all particles
  double h_before = 0;         ///< length of the previous step [s]; 0: none
  std::span<const Vec3> x_before, v_before = {};
};

}  // namespace weft
