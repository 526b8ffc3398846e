// Cameras of a frame as other programs place them.
#pragma once

#include <string>

#include "core/types.hpp"

namespace weft::exporter {

/// A camera that stands somewhere, whether the scene placed it there or it was found.
struct View {
  std::string name;
  Eigen::Matrix4d world_from_view = Eigen::Matrix4d::Identity();  ///< columns: right, up, backward; position [m]
  double field_of_view = 35;                                      ///< vertical, degrees
};

}  // namespace weft::exporter
