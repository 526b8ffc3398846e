// Cameras of a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::scene {

struct CameraKey {
  double time = 0;                          ///< [s]
  Vec3 position{0, 0, 0}, target{0, 0, 0};  ///< [m]
  double field_of_view = 35;                ///< vertical [degrees]; 0 (kind `track`): as wide as the subject needs
  double focal_length = 0;                  ///< [mm]; replaces the field of view; 0: none
};

/// Cameras placed by the scene or a file, or computed from all frames of a run.
enum class CameraKind { placed, whole, follow, close, track, file };

inline bool is_computed(CameraKind kind) {
  return kind != CameraKind::placed && kind != CameraKind::file;
}

/// Default vertical field of view of computed cameras except `track` [degrees]: a portrait lens, little distortion.
inline constexpr double kComputedFieldOfView = 30;

struct Camera {
  std::string name;
  CameraKind kind = CameraKind::placed;
  std::vector<CameraKey> keys;  ///< at least one; computed cameras use its lens and, for `track`, its position
  motion::Interpolation interpolation = motion::Interpolation::cubic;
  std::vector<std::string> subjects =
      {};                  ///< names; if empty: for `whole` all but infinite floors, for others characters, else cloths
  double azimuth = 33;     ///< of the camera position, from the front to the right [degrees]
  double elevation = 17;   ///< of the camera position above the subject [degrees]
  double orbit = 0;        ///< rate at which the azimuth grows [degrees/s]
  double margin = 0.14;    ///< width of the free margin around the subject / half of the picture's size
  double smoothing = 0.5;  ///< time over which the paths of subject and camera are smoothed [s]
  double aperture = 0;     ///< f-number, for a film 24 mm high or the given sensor; 0: everything is sharp
  double focus = 0;        ///< focus distance [m]; 0: that of the target
  std::filesystem::path file = {};  ///< file with the path and the lens of the camera
  std::string object = {};          ///< name of the camera's node in the file; empty: the only camera
  double start = 0;                 ///< scene time at which the time of the file begins [s]
  double scale = 1;                 ///< factor on lengths of the file
  int line = 0, column = 0;         ///< place of the camera in the scene file, for error messages
  double sensor_width = 36;         ///< sensor size along the longer side of the picture [mm]; used with a focal length
  std::string follow = {};          ///< placed cameras: obstacle or "<character>.<part>" to move with; empty: none
  bool follow_rotation = true;      ///< false: the camera follows only the translation
};

/// Whether the scene gives the lens of the camera as a focal length.
inline bool has_focal_length(const Camera& camera) {
  return camera.keys.front().focal_length > 0;
}

}  // namespace weft::scene
