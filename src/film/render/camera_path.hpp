// The camera of a run: placed by the scene, or computed from all frames of the run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/framing.hpp"

namespace weft::render {

/// The camera of each frame of a run. If it is computed, the path reads all frames before it gives the first camera.
class CameraPath {
 public:
  /// `camera`: name of the camera. If it is empty: the scene's first camera or, without cameras, automatic_camera().
  /// `aspect`: width / height of the pictures.
  CameraPath(std::string camera, double aspect) : name_(std::move(camera)), aspect_(aspect) {}

  /// Whether the camera is computed from the frames of the run, instead of placed by the scene.
  /// Throws as find_camera() does.
  static bool is_computed(const frame::FrameSnapshot& snapshot, const std::string& camera);

  /// To compute the camera, call add_frame() with every frame of the run, in order, and then compute_cameras().
  void add_frame(const frame::FrameSnapshot& snapshot);
  void compute_cameras();

  /// The camera of a frame. Throws as find_camera() does. A computed camera needs an earlier call of compute_cameras()
  /// with at least one added frame. The result is then the camera of the last added frame that is not later than
  /// `snapshot` or, if all added frames are later, of the first one.
  frame::Camera at(const frame::FrameSnapshot& snapshot) const;

 private:
  /// One frame: its camera, the positions of the eye from which the subjects are in view (`fit`),
  /// and the bounding box of the subjects [m].
  struct Frame {
    int number = 0;
    double time = 0;
    frame::Camera camera;
    FrustumFit fit;
    Box3 subjects;
  };

  void compute_fixed_camera();
  void compute_orbit();
  void compute_following_camera();
  void compute_tracking_camera();
  std::vector<double> kernel() const;
  std::vector<Vec3> smooth_centers() const;

  std::string name_;
  double aspect_;
  std::vector<Frame> frames_;
  Vec3 up_ = Vec3::UnitZ();        // upward axis of the scene
  std::optional<Box3> cloth_box_;  // kind `whole` ignores cloth beyond this box (kClothRange)
  Box3 subject_bounds_;            // bounds of the subjects of all frames
  bool azimuth_changes_ = false;   // the azimuth differs between frames
};

/// The camera of a frame: placed by the scene, or computed from this frame alone. Parameters: as
/// for CameraPath. The result has the kind `placed`.
frame::Camera camera_of(const frame::FrameSnapshot& snapshot, const std::string& camera, double aspect);

}  // namespace weft::render
