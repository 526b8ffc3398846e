// Velocity cones: bounds of the motion of a set of points (Etzmuß et al. 2001, "Lazy Hierarchy Update", Fig. 4).
#pragma once

#include "core/types.hpp"

namespace weft::collision {

/// All motions of a set lie in the ball around `mean` with `radius`. Seen from the origin, that ball is the cone of the
/// paper. A ball is stored because two balls bound a relative motion without trigonometry. Motions are displacements
/// [m] over one common time.
struct VelocityCone {
  Vec3 mean = Vec3::Zero();
  double radius = 0;

  /// Bound of the difference of two motions of one point, the earlier one in `then` and the later one in `now`.
  friend VelocityCone operator-(const VelocityCone& now, const VelocityCone& then) {
    return {now.mean - then.mean, now.radius + then.radius};
  }

  /// Bound of the motion of a point of one set relative to a point of the other [m]: 0 for equal translations.
  friend double relative_motion(const VelocityCone& a, const VelocityCone& b) {
    constexpr double kRoundUp = 1 + 0x1p-48;  // a few roundings of sums and roots
    return ((a.mean - b.mean).norm() + a.radius + b.radius) * kRoundUp;
  }
};

}  // namespace weft::collision
