// From the environment to what a frame shows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "environment/environment.hpp"
#include "environment/spline.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// Makes the snapshots of a run; what stays the same over the run is made once and shared.
class SnapshotMaker {
 public:
  SnapshotMaker(const scene::Scene& scene, const environment::Environment& environment);

  /// `particles`: of all cloths [m]; `heat`: one list per cloth, empty where none is asked for.
  frame::SnapshotPtr make(int frame, double time, const environment::Environment& environment,
                          std::span<const Vec3> particles, std::vector<std::vector<float>> heat) const;

 private:
  std::vector<frame::Camera> cameras_at(double time) const;
  std::vector<frame::Light> lights_at(double time) const;

  std::shared_ptr<const frame::Stage> stage_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;
  std::vector<frame::Camera> cameras_;
  std::vector<frame::Light> lights_;
  // Through their keys: position, target, field of view; direction, position, target, intensity.
  std::vector<environment::Spline<7>> camera_tracks_;
  std::vector<environment::Spline<10>> light_tracks_;
};

}  // namespace weft::simulation
