// Cameras from files, with the way that they take.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::assets {

/// A camera of a file as it moves: at each time where it stands and looks. Between the times, which are close to each
/// other, all are on straight lines. At least one time.
struct LoadedCamera {
  std::vector<double> times;    ///< [s], increasing
  std::vector<Vec3> positions;  ///< [m]; y is up
  std::vector<Vec3> forward;    ///< unit length
  double field_of_view = 0;     ///< vertical [degrees]
  double roll = 0;              ///< the largest angle by which it is tilted to a side [degrees]
};

/// Reads the camera on the node `object` of a glTF file, or the only one where that is empty, moved by the first
/// animation that moves it. `where` names what refers to the file, such as "scenes/a.toml:12:8: camera.shot". Throws
/// Error(asset_unreadable) with `where`, the file and what is wrong.
LoadedCamera load_camera(const std::filesystem::path& file, const std::string& object, const std::string& where);

}  // namespace weft::assets
