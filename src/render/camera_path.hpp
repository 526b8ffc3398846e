// The camera of a run: where the scene places it, or found from all frames before the first is drawn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/framing.hpp"

namespace weft::render {

class CameraPath {
 public:
  /// `camera`: its name; empty: the first of the scene, else one that has all of the run in view. `aspect`: width over
  /// height of the pictures.
  CameraPath(std::string camera, double aspect) : name_(std::move(camera)), aspect_(aspect) {}

  /// Whether the camera has to see frames before they are drawn. Throws as find_camera() does.
  static bool is_computed(const frame::FrameSnapshot& snapshot, const std::string& camera);

  /// Every frame of the run, in their order; then find().
  void see(const frame::FrameSnapshot& snapshot);
  void find();

  /// The camera of a frame; where it is found, of the last frame up to this one that was seen, at least one.
  frame::Camera at(const frame::FrameSnapshot& snapshot) const;

 private:
  /// What a frame asks of the camera, and what it gets.
  struct Frame {
    int number = 0;
    double time = 0;
    frame::Camera camera;
    FrustumFit fit;
    Box3 subjects;
  };

  void stand_still();
  void go_around();
  void follow();
  void turn_after();
  double frames_in(double seconds) const;
  std::vector<Vec3> smooth_centers() const;

  std::string name_;
  double aspect_;
  std::vector<Frame> frames_;
  std::optional<Box3> reach_;  // in which cloth counts
  Box3 seen_;                  // of all frames
  bool turns_ = false;         // axes differ between frames
};

/// The camera of a frame that is looked at alone.
frame::Camera camera_of(const frame::FrameSnapshot& snapshot, const std::string& camera, double aspect);

}  // namespace weft::render
