// The camera of a run: placed by the scene, or computed from all frames before the first is drawn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/framing.hpp"

namespace weft::render {

class CameraPath {
 public:
  /// `camera`: name of the camera. Empty: the scene's first camera; without any, one that shows the whole run.
  /// `aspect`: width / height of the pictures.
  CameraPath(std::string camera, double aspect) : name_(std::move(camera)), aspect_(aspect) {}

  /// Whether the camera needs all frames before the first can be drawn. Throws as find_camera() does.
  static bool is_computed(const frame::FrameSnapshot& snapshot, const std::string& camera);

  /// Call add_frame() with every frame of the run, in order; then compute_cameras().
  void add_frame(const frame::FrameSnapshot& snapshot);
  void compute_cameras();

  /// The camera of a frame. If the camera is computed, add_frame() must have received at least one frame. The result is
  /// then that of the last such frame whose number is at most that of `snapshot`, or of the first frame if all are
  /// later.
  frame::Camera at(const frame::FrameSnapshot& snapshot) const;

 private:
  /// One frame: the points that must be in view (`fit`), their bounding box, and the camera.
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
  double frames_in(double seconds) const;
  std::vector<Vec3> smooth_centers() const;

  std::string name_;
  double aspect_;
  std::vector<Frame> frames_;
  Vec3 up_ = Vec3::UnitZ();        // upward axis of the scene
  std::optional<Box3> cloth_box_;  // box that limits how far a camera of kind `whole` follows cloth (kClothRange)
  Box3 subject_bounds_;            // bounds of the subjects of all frames
  bool azimuth_changes_ = false;   // the azimuth differs between frames
};

/// The camera for a single frame, computed from this frame alone.
frame::Camera camera_of(const frame::FrameSnapshot& snapshot, const std::string& camera, double aspect);

}  // namespace weft::render
