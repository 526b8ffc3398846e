#include "film/environment/followers.hpp"

#include "film/environment/parents.hpp"

namespace weft::environment {
namespace {

FollowerPoints frame_at(const std::string& part, const Vec3& origin) {
  FollowerPoints frame{part, {origin}};
  for (int axis = 0; axis < 3; ++axis) frame.places.push_back(origin + kFrameAxis * Vec3::Unit(axis));
  return frame;
}

/// Position of an obstacle at its first key; without keys, that of its pose.
const Vec3& place_of(const scene::Obstacle& obstacle) {
  return obstacle.motion.keys.empty() ? obstacle.pose.position : obstacle.motion.keys.front().pose.position;
}

}  // namespace

Followers followers_of(const scene::Scene& scene, const std::vector<model::Cloth>& cloths,
                       const std::string& character) {
  Followers followers;
  std::size_t first = 0;
  const auto add = [&](FollowerPoints points) {
    first += points.places.size();
    followers.points.push_back(std::move(points));
  };
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    for (std::size_t p = 0; p < scene.cloths[c].pins.size(); ++p) {
      const scene::Followed followed = scene::followed(scene.cloths[c].pins[p].follow);
      if (followed.body != character) continue;
      FollowerPoints pin{followed.part, {}};
      for (const model::WeightedParticle& chosen : cloths[c].pins[p].particles)
        pin.places.push_back(cloths[c].start[chosen.particle]);
      followers.pins.push_back({c, p, first});
      add(std::move(pin));
    }
  }
  const auto add_rigid = [&](bool camera, std::size_t number, const std::string& follow, const Vec3& origin) {
    const scene::Followed followed = scene::followed(follow);
    if (followed.body != character) return;
    followers.rigid.push_back({camera, number, first});
    add(frame_at(followed.part, origin));
  };
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    add_rigid(false, i, scene.obstacles[i].follow, place_of(scene.obstacles[i]));
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    add_rigid(true, i, scene.cameras[i].follow, scene.cameras[i].keys.front().position);
  return followers;
}

}  // namespace weft::environment
