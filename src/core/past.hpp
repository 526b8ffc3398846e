// What a method of integration knows of the steps before.
#pragma once

#include <span>

#include "core/types.hpp"

namespace weft {

/// Positions of one time in the past, and how they count: with v = rate (x − Σ weight xₖ) the rate of any quantity q of
/// the positions is rate (q(x) − Σ weight q(xₖ)). That of a length, unlike n·v, is zero for what turns rigidly however
/// far in a step.
struct Past {
  std::span<const Vec3> x;
  double weight = 0;
};

/// Particles at the start of a step over h, and at the start of the step before it. Positions [m], velocities [m/s].
struct StepStart {
  double h = 0;                ///< [s]
  std::span<const Vec3> x, v;  ///< of all particles
  double h_before = 0;         ///< length of the step before [s]; 0: there was none
  std::span<const Vec3> x_before, v_before = {};
};

}  // namespace weft
