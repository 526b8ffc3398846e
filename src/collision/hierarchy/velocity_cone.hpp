// Velocity cones: how a set of points moves, in a few numbers (seed, "Lazy Hierarchy Update", Fig. 4).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.hpp"

namespace weft::collision {

/// All motions of a set lie in the ball around `mean`; seen from the origin that ball is the seed's cone with its
/// direction, opening angle and size. Kept as a ball because two of them bound a relative motion without trigonometry.
/// Motions are displacements [m] over one common time.
class VelocityCone {
 public:
  VelocityCone() = default;
  explicit VelocityCone(const Vec3& motion) : mean_(motion), radius_(0) {}
  VelocityCone(const Vec3& mean, double radius) : mean_(mean), radius_(radius) {}

  /// Smallest ball around this cone's and the other's.
  void join(const VelocityCone& other) {
    if (radius_ < 0) *this = other;
    if (other.radius_ < 0) return;
    const Vec3 way = other.mean_ - mean_;
    const double distance = way.norm();
    if (distance + other.radius_ <= radius_) return;
    if (distance + radius_ <= other.radius_) {
      *this = other;
      return;
    }
    const double radius = 0.5 * (distance + radius_ + other.radius_);
    mean_ += way * ((radius - radius_) / distance);
    radius_ = radius * kRoundUp;
  }

  bool empty() const { return radius_ < 0; }
  const Vec3& mean() const { return mean_; }
  double radius() const { return radius_; }

  /// Length of the longest motion [m]: how far the set moves at most.
  double size() const { return (mean_.norm() + radius_) * kRoundUp; }
  /// Unit vector; nothing in particular where the set does not move.
  Vec3 direction() const { return mean_.norm() > 0 ? Vec3(mean_ / mean_.norm()) : Vec3::UnitX(); }
  /// Largest angle between a motion and the direction [rad]; π where the origin is inside the ball.
  double half_angle() const {
    const double length = mean_.norm();
    return radius_ < length ? std::asin(std::max(radius_, 0.0) / length) : M_PI;
  }

  /// No point of one set moves farther than this [m] relative to a point of the other: 0 for equal translations,
  /// however fast.
  friend double relative_motion(const VelocityCone& a, const VelocityCone& b) {
    return ((a.mean_ - b.mean_).norm() + a.radius_ + b.radius_) * kRoundUp;
  }

 private:
  static constexpr double kRoundUp = 1 + 0x1p-48;  // a few roundings of sums and roots

  Vec3 mean_ = Vec3::Zero();
  double radius_ = -1;  // below 0: empty set
};

}  // namespace weft::collision
