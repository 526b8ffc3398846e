// Reads cameras and their motion from glTF files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::assets {

/// A camera of a file, sampled at one or more times. Samples of a motion are at most 0.02 s apart, so that linear
/// interpolation between them is accurate enough.
struct LoadedCamera {
  std::vector<double> times;    ///< [s], increasing
  std::vector<Vec3> positions;  ///< [m], in axes with y up
  std::vector<Vec3> forward;    ///< viewing directions, unit length
  double field_of_view = 0;     ///< vertical [degrees]
  /// Largest roll of all samples [degrees]. The roll is the angle between the side vector of the camera and the
  /// horizontal plane or, if the camera is upside down, 180 minus this angle.
  double roll = 0;
};

/// Reads the camera with the name `object` from a glTF file (empty: the only camera), with the first animation that
/// moves the node of the camera or one of its ancestors. `where` names the scene entry, such as "scenes/a.toml:12:8:
/// camera.shot". Throws Error(asset_unreadable) with `where`, the file and the reason.
LoadedCamera load_camera(const std::filesystem::path& file, const std::string& object, const std::string& where);

}  // namespace weft::assets
