// From the environment to what a frame shows.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "environment/environment.hpp"
#include "environment/picture_places.hpp"
#include "environment/spline.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"
#include "simulation/camera_mounts.hpp"

namespace weft::simulation {

/// Pictures of files, each decoded once.
class Pictures {
 public:
  /// Throws Error(scene_invalid) where the file cannot be read any more: scenes are checked for that.
  std::shared_ptr<const frame::Texture> of_file(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::shared_ptr<const frame::Texture>> known_;
};

/// What of a scene is drawn and not simulated: colours, surroundings, cameras and lights.
class Looks {
 public:
  /// `environment`: of the scene; null: made where a camera follows something.
  explicit Looks(const scene::Scene& scene, const environment::Environment* environment = nullptr);

  /// The same frame with these looks; it is of a scene that has the same objects.
  frame::SnapshotPtr put_on(const frame::FrameSnapshot& snapshot);
  /// Stage, cameras and lights; of a frame that has its positions.
  void surround(frame::FrameSnapshot& snapshot) const;
  /// Where the picture of an obstacle lies; leaves all else.
  void place_picture(frame::Surface& surface) const;

 private:
  std::shared_ptr<const frame::Surface> dressed(const frame::Surface& surface);
  std::vector<frame::Camera> cameras_at(double time) const;
  std::vector<frame::Light> lights_at(double time) const;

  std::map<std::string, scene::Look> looks_;                          // by the name of the object
  std::map<std::string, environment::PicturePlaces> picture_places_;  // of obstacles that have one, likewise
  Pictures pictures_;
  std::shared_ptr<const frame::Stage> stage_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;  // dressed for the first snapshot, shared by the others
  std::vector<frame::Camera> cameras_;
  std::vector<frame::Light> lights_;
  // Through their keys: position, target, field of view or focal length [mm]; direction, position, target, intensity.
  std::vector<environment::Spline<7>> camera_tracks_;
  std::vector<environment::Spline<10>> light_tracks_;
  std::vector<double> orbits_;          // of the cameras [degrees/s]
  std::vector<double> sensor_heights_;  // likewise [mm]; 0: they have a field of view
  std::optional<CameraMounts> mounts_;
};

/// Makes the snapshots of a run; what stays the same over the run is made once and shared.
class SnapshotMaker {
 public:
  SnapshotMaker(const scene::Scene& scene, const environment::Environment& environment);

  /// `particles`: of all cloths [m]; `heat`: one list per cloth, empty where none is asked for; `moved`: vertices of
  /// each body that forces have moved, empty for those that are where their keys have them [m].
  frame::SnapshotPtr make(int frame, double time, const environment::Environment& environment,
                          std::span<const Vec3> particles, std::vector<std::vector<float>> heat,
                          std::vector<std::vector<Vec3>> moved = {}) const;

 private:
  const Looks looks_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;
};

}  // namespace weft::simulation
