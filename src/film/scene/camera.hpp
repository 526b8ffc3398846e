// Cameras of a scene. A "key" here is a key frame: values at one time. Between two keys, values are interpolated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::scene {

/// Position and lens of a camera at one time.
struct CameraKey {
  double time = 0;                          ///< [s]
  Vec3 position{0, 0, 0}, target{0, 0, 0};  ///< [m]
  double field_of_view = 35;                ///< vertical [degrees]; 0 (kind `track` only): as wide as the subject needs
  double focal_length = 0;                  ///< [mm]; if not 0, replaces the field of view
};

/// `placed`: the scene gives key frames. `file`: a file gives position and lens. The other kinds are computed from all
/// frames of a run: `whole` shows the whole run, `follow` moves along at a constant distance, `close` is as near as the
/// subject allows, `track` stands still and turns.
enum class CameraKind { placed, whole, follow, close, track, file };

inline bool is_computed(CameraKind kind) {
  return kind != CameraKind::placed && kind != CameraKind::file;
}

/// Default vertical field of view of computed cameras except `track` [degrees]: that of a portrait lens, because it has
/// little perspective distortion.
inline constexpr double kComputedFieldOfView = 30;

struct Camera {
  std::string name;
  CameraKind kind = CameraKind::placed;
  /// At least one. Computed cameras use only the lens of the first key; kind `track` also uses its position.
  std::vector<CameraKey> keys;
  motion::Interpolation interpolation = motion::Interpolation::cubic;
  /// Names of the objects that a computed camera shows. If empty: for kind `whole`, all objects except infinite planes;
  /// for the other kinds, all characters; without characters, all cloths; without both, as for `whole`.
  std::vector<std::string> subjects = {};
  double azimuth = 33;     ///< of the direction from subject to camera [degrees]; if z is up, 0: −y, 90: +x
  double elevation = 17;   ///< of the direction from subject to camera, above the horizontal [degrees]
  double orbit = 0;        ///< rate at which the azimuth grows [degrees/s]
  double margin = 0.14;    ///< fraction of each half of the picture that stays free around the subject
  double smoothing = 0.5;  ///< standard deviation of the Gaussian that smooths the motion of the camera [s]
  double aperture = 0;     ///< f-number, for the height of the sensor (24 mm without focal length); 0: no blur
  double focus = 0;        ///< focus distance [m]; 0: distance of the target; required by kind `file` with an aperture
  std::filesystem::path file = {};  ///< kind `file`: file with position and lens over time
  std::string object = {};          ///< node of the camera in the file; empty: the only camera
  double start = 0;                 ///< scene time that corresponds to time 0 of the file [s]
  double scale = 1;                 ///< factor on lengths of the file
  int line = 0, column = 0;         ///< place in the scene file, for error messages
  double sensor_width = 36;         ///< width of the sensor along the longer side of the picture
                                    ///< [mm]; used only with a focal length
  std::string follow = {};          ///< `placed`: obstacle or "<character>.<part>" to move with; empty: none
  bool follow_rotation = true;      ///< false: the camera follows only the translation
};

/// Whether the scene gives the lens of the camera as a focal length.
inline bool has_focal_length(const Camera& camera) {
  return camera.keys.front().focal_length > 0;
}

}  // namespace weft::scene
