// Cameras of a frame as other programs place them.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Clipping planes of exported cameras, before and behind all that is seen [m].
inline constexpr double kNearPlane = 0.01, kFarPlane = 1000;

/// A camera that stands somewhere, whether the scene placed it there or it was found.
struct View {
  std::string name;
  Eigen::Matrix4d world_from_view = Eigen::Matrix4d::Identity();  ///< columns: right, up, backward; position [m]
  double field_of_view = 35;                                      ///< vertical, degrees
};

/// What lights a film, as its pictures show it.
struct Lighting {
  std::vector<frame::Light> lights = {};
  Vec3 sky_color = Vec3::Ones();  ///< linear
  double sky_share = 0.45;        ///< of all light; the lights give the rest
};

}  // namespace weft::exporter
