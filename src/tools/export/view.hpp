// Cameras and lights of a frame for other programs.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "film/frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Clipping planes of exported cameras [m].
inline constexpr double kNearPlane = 0.01, kFarPlane = 1000;

/// A camera with its pose in one frame.
struct View {
  std::string name;
  Eigen::Matrix4d world_from_view = Eigen::Matrix4d::Identity();  ///< columns: right, up, backward; position [m]
  double field_of_view = 35;                                      ///< vertical [degrees]
};

/// The lighting of one frame, as in its picture.
struct Lighting {
  std::vector<frame::Light> lights = {};
  Vec3 sky_color = Vec3::Ones();  ///< linear
  double sky_fraction = 0.45;     ///< fraction of all light that comes from the sky; the lights provide the rest
};

}  // namespace weft::exporter
