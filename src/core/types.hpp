// Types that all modules use.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace weft {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Box3 = Eigen::AlignedBox3d;

/// Index of a particle, a vertex or a face.
using Index = std::int32_t;

/// Converts an index, which must not be negative, to a container position.
inline std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// Tolerance for ratios and for lengths [m]: far above rounding errors, far below all sizes that matter.
inline constexpr double kRoundoff = 1e-9;

inline constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

}  // namespace weft
