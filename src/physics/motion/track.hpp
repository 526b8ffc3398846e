// Key-framed motion of rigid bodies and pins.
#pragma once

#include <vector>

#include "physics/motion/pose.hpp"
#include "physics/motion/spline.hpp"

namespace weft::motion {

/// A pose with its velocities and accelerations, in world space.
struct PoseSample {
  Vec3 position{0, 0, 0};              ///< of the body's origin [m]
  Quat rotation{1, 0, 0, 0};           ///< body to world
  Vec3 velocity{0, 0, 0};              ///< [m/s]
  Vec3 angular_velocity{0, 0, 0};      ///< [rad/s]
  Vec3 acceleration{0, 0, 0};          ///< [m/s²]
  Vec3 angular_acceleration{0, 0, 0};  ///< [rad/s²]

  /// World velocity [m/s] of the body's point at position + `arm`; `arm`: in world axes [m].
  Vec3 velocity_at(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }

  /// World acceleration [m/s²] of the same point.
  Vec3 acceleration_at(const Vec3& arm) const {
    return acceleration + angular_acceleration.cross(arm) + angular_velocity.cross(angular_velocity.cross(arm));
  }
};

/// World motion of an object that follows `parent`: the product of poses parent · parent_start⁻¹ · own, with exact
/// derivatives. `own`: motion of the object if the parent stays at `parent_start`.
PoseSample compose(const PoseSample& parent, const Pose& parent_start, const PoseSample& own);

/// Interpolates rotations through keys. From one key to the next, the object rotates by the
/// smallest possible angle. If this angle is half a turn, both directions are possible; then the
/// object takes the one closer to its rotation in the segment before. If both keys have Euler
/// angles (change_of_angles() in pose.hpp) and at most one of the three differs, the object rotates
/// by that difference instead, including whole turns.
///
/// Linear: constant angular velocity between keys (slerp). Cubic: a chain of cubic Bézier curves of unit quaternions
/// with derivatives in closed form (Kim, Kim & Shin, "A general construction scheme for unit quaternion curves with
/// simple high order derivatives", SIGGRAPH 1995). The angular velocity is then continuous. At the keys, it
/// comes from slopes_between_keys() (spline.hpp), which here gets the rotation vectors from key to key in place of the
/// differences of values. So if the axis is fixed, the angle is the same as that of a Spline through the angles of the
/// keys.
class RotationSpline {
 public:
  struct Sample {
    Quat rotation;
    Vec3 angular_velocity{0, 0, 0};      ///< [rad/s], world
    Vec3 angular_acceleration{0, 0, 0};  ///< [rad/s²], world
  };

  /// Needs at least one key, as many poses as times, and strictly increasing times [s].
  RotationSpline(Interpolation interpolation, std::vector<double> times, std::vector<Pose> poses);

  Sample at(double t) const;

 private:
  /// One segment between two keys: q(u) = exp(b3(u) w3) exp(b2(u) w2) exp(b1(u) w1) q0 with u from 0 to 1 and the
  /// cumulative Bernstein basis b1 = 1 - (1-u)³, b2 = 3u² - 2u³, b3 = u³. Linear: only w2, with b2 = u.
  struct Segment {
    double start, length;  // [s]
    Quat q0;
    Vec3 w1, w2, w3;  // rotation vectors [rad]
  };

  Interpolation interpolation_;
  std::vector<double> times_;
  std::vector<Quat> rotations_;
  std::vector<Segment> segments_;
};

/// The pose of a PoseTrack at any time. Before the first key and from the last key on, the pose does not change. If
/// there are several keys, the velocity at the first one is that of the first segment.
class Track {
 public:
  /// `rest`: the pose of a track without keys.
  explicit Track(const PoseTrack& track, const Pose& rest = {});

  /// Takes time O(log keys); allocates nothing.
  PoseSample at(double t) const;

  /// Whether the track has more than one key.
  bool is_moving() const { return times_.size() > 1; }

 private:
  std::vector<double> times_;  // of the keys [s]; without keys, one time
  Spline<3> position_;
  RotationSpline rotation_;
};

}  // namespace weft::motion
