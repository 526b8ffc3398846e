// Reads cameras and their motion from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::assets {

/// A moving camera of a file, sampled at one or more times that are close enough for linear interpolation in between.
struct LoadedCamera {
  std::vector<double> times;    ///< [s], increasing
  std::vector<Vec3> positions;  ///< [m], in axes with y up
  std::vector<Vec3> forward;    ///< viewing directions, unit length
  double field_of_view = 0;     ///< vertical [degrees]
  double roll = 0;              ///< largest angle between the camera's side vector and the horizontal, 180 if it is
                                ///< upside down [degrees]
};

/// Reads the camera on the node `object` of a glTF file (empty: the only camera), and the first animation that moves
/// it. `where` names the scene entry, such as "scenes/a.toml:12:8: camera.shot". Throws Error(asset_unreadable) with
/// `where`, the file and the reason.
LoadedCamera load_camera(const std::filesystem::path& file, const std::string& object, const std::string& where);

}  // namespace weft::assets
