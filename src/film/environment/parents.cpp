#include "film/environment/parents.hpp"

#include <algorithm>

#include "film/environment/environment.hpp"
#include "film/environment/followers.hpp"
#include "film/scene/following.hpp"

namespace weft::environment {

std::shared_ptr<const motion::Track> track_of_frame(const motion::KeyFrames& keys, std::size_t first,
                                                    scene::Interpolation interpolation) {
  scene::PoseTrack track{interpolation, {}};
  for (const double time : keys.times()) {
    const Vec3 origin = keys.at(time, first).position;
    Mat3 axes;
    for (int axis = 0; axis < 3; ++axis)
      axes.col(axis) = (keys.at(time, first + 1 + static_cast<std::size_t>(axis)).position - origin) / kFrameAxis;
    track.keys.push_back({time, {origin, Quat(motion::best_rotation(axes))}});
  }
  return std::make_shared<const motion::Track>(track);
}

// At the start, every object has the pose of its own keys, even if it follows another object.
void Environment::add_parents(const scene::Scene& scene) {
  // The obstacle with the name `follow`; none if `follow` is empty or names a part of a character.
  const auto parent_at_start = [&](const std::string& follow) {
    model::Parent parent;
    const auto found = std::ranges::find(scene.obstacles, follow, &scene::Obstacle::name);
    if (follow.empty() || found == scene.obstacles.end()) return parent;
    parent.body = static_cast<std::size_t>(found - scene.obstacles.begin());
    const motion::PoseSample start = std::get<motion::Track>(*model.bodies[parent.body].mover).at(scene.start_time());
    parent.start = {start.position, start.rotation};
    return parent;
  };
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
    model.bodies[o].parent = parent_at_start(scene.obstacles[o].follow);
    if (scene::has_prescribed_motion(scene, scene.obstacles[o])) model.bodies[o].may_move = true;
  }
  if (std::ranges::all_of(scene.cameras, [](const auto& camera) { return camera.follow.empty(); })) return;
  for (const scene::Camera& camera : scene.cameras) camera_parents.push_back(parent_at_start(camera.follow));
}

void Environment::add_part_parents(const scene::Scene& scene, const scene::Character& character,
                                   const Followers& followers, const motion::KeyFrames& keys) {
  for (const PartFollower& follower : followers.rigid) {
    model::Parent& parent = follower.camera ? camera_parents[follower.number] : model.bodies[follower.number].parent;
    parent.part = track_of_frame(keys, follower.first, character.interpolation);
    const motion::PoseSample start = parent.part->at(scene.start_time());
    parent.start = {start.position, start.rotation};
  }
}

}  // namespace weft::environment
