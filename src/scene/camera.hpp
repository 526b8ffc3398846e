// Cameras of a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "scene/keyed.hpp"

namespace weft::scene {

struct CameraKey {
  double time = 0;
  Vec3 position{0, 0, 0}, target{0, 0, 0};  ///< [m]
  double field_of_view = 35;                ///< vertical [degrees]
  double focal_length = 0;                  ///< in place of it [mm]; 0: none
};

/// Placed by the scene or by a file, or found from all frames of a run.
enum class CameraKind { placed, whole, follow, close, track, file };

inline bool is_found(CameraKind kind) {
  return kind != CameraKind::placed && kind != CameraKind::file;
}

/// Of cameras that are found: a portrait lens, with little distortion.
inline constexpr double kFoundFieldOfView = 30;  // [degrees]

struct Camera {
  std::string name;
  CameraKind kind = CameraKind::placed;
  std::vector<CameraKey> keys;  ///< at least one; one: still. Found ones have one, for position and field of view
  Interpolation interpolation = Interpolation::cubic;
  std::vector<std::string> subjects =
      {};                           ///< objects that it shows; empty: the characters, else the cloths; whole: all
  double azimuth = 33;              ///< of the eye, from the front to the right [degrees]
  double elevation = 17;            ///< above the subject [degrees]
  double orbit = 0;                 ///< by which the azimuth grows [degrees/s]
  double margin = 0.14;             ///< share of each half picture that is left free around the subject
  double smoothing = 0.5;           ///< of the ways of the subject and the eye [s]
  double aperture = 0;              ///< f-number of a camera with 24 mm of film; 0: all is sharp
  double focus = 0;                 ///< distance that is sharp [m]; 0: that of the target
  std::filesystem::path file = {};  ///< that has its way and lens
  std::string object = {};          ///< name of its node there; empty: the only one
  double start = 0;                 ///< when the time of the file begins [s]
  double scale = 1;                 ///< of its lengths
  int line = 0, column = 0;         ///< where the scene names it, for errors of its file
  double sensor_width = 36;         ///< of the longer side of the picture, where it has a focal length [mm]
  std::string follow = {};          ///< placed: obstacle or "<character>.<part>" with which it moves; empty: none
  bool follow_rotation = true;      ///< else with its translation alone
};

/// Whether its lens is given in millimetres.
inline bool has_focal_length(const Camera& camera) {
  return camera.keys.front().focal_length > 0;
}

}  // namespace weft::scene
