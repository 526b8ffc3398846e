// Makes the snapshots of frames from the environment and the state of the particles.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/environment/picture_places.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/production/camera_mounts.hpp"
#include "film/scene/scene.hpp"
#include "physics/motion/spline.hpp"

namespace weft::production {

/// Textures from picture files, each decoded once.
class Pictures {
 public:
  /// Throws Error(scene_invalid) if the file can no longer be read; scenes are checked for that when they are read.
  std::shared_ptr<const frame::Texture> of_file(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::shared_ptr<const frame::Texture>> known_;
};

/// The data of a scene that are drawn but not simulated: colours, surroundings, cameras and lights.
class Looks {
 public:
  /// `environment`: of the same scene. If it is null and a camera follows a body, the constructor makes one.
  explicit Looks(const scene::Scene& scene, const environment::Environment* environment = nullptr);

  /// A copy of the snapshot with these looks. The snapshot must have the same objects as the scene.
  frame::SnapshotPtr put_on(const frame::FrameSnapshot& snapshot);
  /// Sets stage, cameras and lights of a snapshot whose positions are set.
  void surround(frame::FrameSnapshot& snapshot) const;
  /// Sets only the texture coordinates of an obstacle's picture.
  void place_picture(frame::Surface& surface) const;

 private:
  std::shared_ptr<const frame::Surface> dressed(const frame::Surface& surface);
  std::vector<frame::Camera> cameras_at(double time) const;
  std::vector<frame::Light> lights_at(double time) const;

  std::map<std::string, scene::Look> looks_;                          // by name of the object
  std::map<std::string, environment::PicturePlaces> picture_places_;  // of obstacles with a picture, by name
  Pictures pictures_;
  std::shared_ptr<const frame::Stage> stage_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;  // made for the first snapshot, shared by the others
  std::vector<frame::Camera> cameras_;
  std::vector<frame::Light> lights_;
  // Camera keys: position, target, field of view [degrees] or focal length [mm]. Light keys: direction, position,
  // target, intensity.
  std::vector<motion::Spline<7>> camera_tracks_;
  std::vector<motion::Spline<10>> light_tracks_;
  std::vector<double> orbits_;          // of the cameras [degrees/s]
  std::vector<double> sensor_heights_;  // of the cameras [mm]; 0 for cameras with a field of view
  std::optional<CameraMounts> mounts_;
};

/// Makes the snapshots of a run. Data that stay the same over the run are made once; all snapshots share them.
class SnapshotMaker {
 public:
  SnapshotMaker(const scene::Scene& scene, const environment::Environment& environment);

  /// `model`: that of the environment, with its current motions; `particles`: of all cloths [m]; `heat`: one list per
  /// cloth, or none; `moved`: vertices of each body that forces have moved [m], empty for bodies that are where their
  /// keys place them.
  frame::SnapshotPtr make(int frame, double time, const model::Model& model, std::span<const Vec3> particles,
                          std::vector<std::vector<float>> heat, std::vector<std::vector<Vec3>> moved = {}) const;

 private:
  const Looks looks_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;
};

}  // namespace weft::production
