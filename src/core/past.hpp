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

}  // namespace weft
