// Makes snapshots of frames from the environment of a scene and the positions of its particles.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/production/camera_mounts.hpp"
#include "film/scene/scene.hpp"
#include "physics/motion/spline.hpp"

namespace weft::production {

/// Position, target and lens of a camera over time.
struct CameraTrack {
  motion::Spline<7> spline;  ///< position and target [m], field of view [degrees] or focal length [mm]
  std::vector<double> cuts;  ///< times at which the camera jumps [s], increasing
};

/// Makes the snapshots of a run. All snapshots share the data that do not change during the run.
class SnapshotMaker {
 public:
  SnapshotMaker(const scene::Scene& scene, const environment::Environment& environment);

  /// `model`: the model of the simulation, with the current motions. `particles`: positions of the particles of all
  /// cloths [m]. `heat`: per cloth, one value per particle (see frame::Stage::Heat); empty without heat colours.
  /// `moved`: per body, the positions of its vertices [m] if forces have moved the body, otherwise an empty list; may
  /// be empty if forces move no body.
  frame::SnapshotPtr make(int frame, double time, const model::Model& model, std::span<const Vec3> particles,
                          std::vector<std::vector<float>> heat, std::vector<std::vector<Vec3>> moved = {}) const;
  /// Returns a copy of a snapshot with the surfaces, cameras and lights of this scene. The scene of the snapshot must
  /// have the same simulation; its looks and its duration may differ.
  frame::SnapshotPtr with_looks(const frame::FrameSnapshot& snapshot) const;

 private:
  /// Sets surfaces, stage, cameras and lights of a snapshot, which must already have its time and the positions of its
  /// objects.
  void set_looks(frame::FrameSnapshot& snapshot) const;
  std::vector<frame::Camera> cameras_at(double time) const;
  std::vector<frame::Light> lights_at(double time) const;

  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;
  std::shared_ptr<const frame::Stage> stage_;
  std::vector<frame::Camera> cameras_;
  std::vector<frame::Light> lights_;
  std::vector<CameraTrack> camera_tracks_;
  // Values of light tracks: direction, position, target, intensity.
  std::vector<motion::Spline<10>> light_tracks_;
  std::vector<double> orbits_;          // rate of the azimuth of each camera [degrees/s]
  std::vector<double> sensor_heights_;  // height of each sensor [mm]; 0 for cameras with a field of view
  CameraMounts mounts_;
};

}  // namespace weft::production
