// Velocity cones: how a set of points moves, in a few numbers (seed, "Lazy Hierarchy Update", Fig. 4).
#pragma once

#include "core/types.hpp"

namespace weft::collision {

/// All motions of a set lie in the ball around `mean`; seen from the origin that ball is the seed's cone with its
/// direction, opening angle and size. Kept as a ball because two of them bound a relative motion without trigonometry.
/// Motions are displacements [m] over one common time.
struct VelocityCone {
  Vec3 mean = Vec3::Zero();
  double radius = 0;

  /// Of what has been added to motions in `then` since, while they came to be in `now`.
  friend VelocityCone operator-(const VelocityCone& now, const VelocityCone& then) {
    return {now.mean - then.mean, now.radius + then.radius};
  }

  /// No point of one set moves farther than this [m] relative to a point of the other: 0 for equal translations,
  /// however fast.
  friend double relative_motion(const VelocityCone& a, const VelocityCone& b) {
    constexpr double kRoundUp = 1 + 0x1p-48;  // a few roundings of sums and roots
    return ((a.mean - b.mean).norm() + a.radius + b.radius) * kRoundUp;
  }
};

}  // namespace weft::collision
