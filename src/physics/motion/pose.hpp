// Poses of rigid bodies, and their keys.
#pragma once

#include <optional>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::motion {

/// A rigid placement: rotation, then translation.
struct Pose {
  Vec3 position{0, 0, 0};  ///< [m]
  Quat rotation{1, 0, 0, 0};
  std::optional<Vec3> angles{};  ///< of `rotation`, about fixed x, then y, then z [degrees]; may contain whole turns
};

/// Difference of the angles of two poses [degrees]; empty if one of them has no angles. The identity rotation has the
/// angles 0, even if they are not given.
std::optional<Vec3> change_of_angles(const Pose& from, const Pose& to);

/// The rotation R with the largest tr(Rᵀ M). If M is almost a rotation, R is the nearest rotation. If M = Σ (y − ȳ)(x −
/// x̄)ᵀ, R maps points x to y best in the least-squares sense (Kabsch, Acta Cryst. A32, 1976).
Mat3 best_rotation(const Mat3& matrix);

struct PoseKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose;
};

struct PoseTrack {
  Interpolation interpolation = Interpolation::cubic;
  std::vector<PoseKey> keys;  ///< empty: keeps the object's own pose
};

}  // namespace weft::motion
