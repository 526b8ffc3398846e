#include "environment/parents.hpp"

#include <Eigen/SVD>
#include <algorithm>

#include "environment/environment.hpp"
#include "environment/followers.hpp"
#include "scene/following.hpp"

namespace weft::environment {
namespace {

/// The rotation nearest to a matrix that is almost a rotation, from the polar decomposition.
Quat nearest_rotation(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Quat(Mat3(svd.matrixU() * svd.matrixV().transpose()));
}

/// The obstacle that `follow` names; none if `follow` names a part of a character or is empty.
Parent parent_of(const scene::Scene& scene, const std::string& follow) {
  const auto found = std::ranges::find(scene.obstacles, follow, &scene::Obstacle::name);
  if (follow.empty() || found == scene.obstacles.end()) return {};
  return {.obstacle = static_cast<std::size_t>(found - scene.obstacles.begin())};
}

}  // namespace

PoseSample compose(const PoseSample& parent, const scene::Pose& parent_start, const PoseSample& own) {
  const Quat turn = parent.rotation * parent_start.rotation.conjugate();
  const Vec3 arm = turn * (own.position - parent_start.position), drift = turn * own.velocity;
  const Vec3 &omega = parent.angular_velocity, spin = turn * own.angular_velocity;
  PoseSample sample;
  sample.position = parent.position + arm;
  sample.rotation = (turn * own.rotation).normalized();
  sample.velocity = parent.velocity_at(arm) + drift;
  sample.angular_velocity = omega + spin;
  sample.acceleration = parent.acceleration_at(arm) + 2 * omega.cross(drift) + turn * own.acceleration;
  sample.angular_acceleration = parent.angular_acceleration + omega.cross(spin) + turn * own.angular_acceleration;
  return sample;
}

std::shared_ptr<const Track> track_of_frame(const KeyFrames& keys, std::size_t first,
                                            scene::Interpolation interpolation) {
  scene::PoseTrack track{interpolation, {}};
  for (const double time : keys.times()) {
    const Vec3 origin = keys.at(time, first).position;
    Mat3 axes;
    for (int axis = 0; axis < 3; ++axis)
      axes.col(axis) = (keys.at(time, first + 1 + static_cast<std::size_t>(axis)).position - origin) / kFrameAxis;
    track.keys.push_back({time, {origin, nearest_rotation(axes)}});
  }
  return std::make_shared<const Track>(track);
}

// At the start, every object has the pose of its own keys, even if it follows something.
void Environment::add_parents(const scene::Scene& scene) {
  const auto parents_of = [&](const auto& list) {
    std::vector<Parent> parents;
    if (std::ranges::none_of(list, [](const auto& each) { return !each.follow.empty(); })) return parents;
    for (const auto& each : list) {
      Parent& parent = parents.emplace_back(parent_of(scene, each.follow));
      if (parent.obstacle == Parent::kNone) continue;
      const PoseSample start = std::get<Track>(*movers_[parent.obstacle]).at(scene.start_time());
      parent.start = {start.position, start.rotation};
    }
    return parents;
  };
  parents_ = parents_of(scene.obstacles);
  camera_parents = parents_of(scene.cameras);
  for (std::size_t o = 0; o < parents_.size(); ++o)
    if (scene::moves(scene, scene.obstacles[o])) bodies[o].moving = true;
}

void Environment::add_part_parents(const scene::Scene& scene, const scene::Character& character,
                                   const Followers& followers, const KeyFrames& keys) {
  for (const PartFollower& follower : followers.rigid) {
    Parent& parent = (follower.camera ? camera_parents : parents_)[follower.number];
    parent.part = track_of_frame(keys, follower.first, character.interpolation);
    const PoseSample start = parent.part->at(scene.start_time());
    parent.start = {start.position, start.rotation};
  }
}

}  // namespace weft::environment
