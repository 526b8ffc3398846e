// Velocity cones: bounds of the motion of a set of points (Etzmuß et al. 2001, "Lazy Hierarchy Update", Fig. 4).
#pragma once

#include "core/types.hpp"

namespace weft::collision {

/// Bounds the motions of a set of points: displacements [m] over one common time. All of them are in the ball around
/// `mean` with `radius`. Seen from the origin, this ball is the cone of the paper. Two balls, unlike two cones, bound a
/// relative motion without trigonometry.
struct VelocityCone {
  Vec3 mean = Vec3::Zero();
  double radius = 0;

  /// Bound of the difference between a later motion and an earlier one of the same points.
  friend VelocityCone operator-(const VelocityCone& now, const VelocityCone& then) {
    return {now.mean - then.mean, now.radius + then.radius};
  }

  /// Bound of the motion of a point of one set relative to a point of the other [m]; 0 if both sets make the same
  /// translation.
  friend double relative_motion(const VelocityCone& a, const VelocityCone& b) {
    constexpr double kRoundUp = 1 + 0x1p-48;  // exceeds the rounding of a few sums and roots
    return ((a.mean - b.mean).norm() + a.radius + b.radius) * kRoundUp;
  }
};

}  // namespace weft::collision
