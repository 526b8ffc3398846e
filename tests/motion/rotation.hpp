#pragma once

#include "core/types.hpp"

namespace weft::motion {

/// A rotation about an axis of any length [rad].
inline Quat about(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace weft::motion
