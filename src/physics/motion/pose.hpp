// Poses of rigid bodies, and tracks of keyed poses.
#pragma once

#include <optional>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::motion {

/// Position and orientation: a point is first rotated, then translated.
struct Pose {
  Vec3 position{0, 0, 0};  ///< [m]
  Quat rotation{1, 0, 0, 0};
  /// Euler angles of `rotation`, about the fixed axes x, then y, then z [degrees]; may contain whole turns.
  std::optional<Vec3> angles{};
};

/// Pose::angles of `to` minus those of `from` [degrees]; nothing if either pose has no angles. A
/// pose without angles whose rotation is the identity counts as one with the angles 0.
std::optional<Vec3> change_of_angles(const Pose& from, const Pose& to);

/// The rotation R that maximises tr(Rᵀ M), for M = `matrix`. It is the rotation nearest to M in the Frobenius norm. If
/// M = Σ (y − ȳ)(x − x̄)ᵀ, R maps the points x to the points y with the least sum of squared errors (Kabsch, Acta
/// Cryst. A32, 1976).
Mat3 best_rotation(const Mat3& matrix);

struct PoseKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose;
};

struct PoseTrack {
  Interpolation interpolation = Interpolation::cubic;
  std::vector<PoseKey> keys;  ///< empty: the object keeps its rest pose (Track)
};

}  // namespace weft::motion
