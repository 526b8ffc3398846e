// Vocabulary types shared by every module.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
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

}  // namespace weft
