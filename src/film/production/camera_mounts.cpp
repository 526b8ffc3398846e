#include "film/production/camera_mounts.hpp"

#include <span>

namespace weft::production {
namespace {

Vec3 mean_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : points) sum += x;
  return sum / static_cast<double>(points.size());
}

/// The pose that maps `mesh` to `x` best in the least-squares sense. The pose is computed from vertices, because a body
/// that forces move has no key-framed pose.
scene::Pose pose_of(std::span<const Vec3> mesh, std::span<const Vec3> x) {
  const Vec3 middle_mesh = mean_of(mesh), middle = mean_of(x);
  Mat3 covariance = Mat3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) covariance += (x[i] - middle) * (mesh[i] - middle_mesh).transpose();
  const Mat3 rotation = motion::best_rotation(covariance);
  return {middle - rotation * middle_mesh, Quat(rotation)};
}

}  // namespace

CameraMounts::CameraMounts(const scene::Scene& scene, const environment::Environment& environment) {
  for (std::size_t c = 0; c < environment.camera_parents.size(); ++c) {
    const model::Parent& parent = environment.camera_parents[c];
    if (!parent.is_any()) continue;
    Mount& mount = mounts_.emplace_back(Mount{c, parent, scene.cameras[c].follow_rotation, 0, {}});
    if (parent.part) continue;
    mount.surface = environment.cloths.size() + parent.body;
    mount.mesh = environment.model.bodies[parent.body].mesh.positions;
  }
}

void CameraMounts::move(frame::FrameSnapshot& snapshot) const {
  for (const Mount& mount : mounts_) {
    scene::Pose now;
    if (mount.parent.part) {
      const motion::PoseSample sample = mount.parent.part->at(snapshot.time);
      now = {sample.position, sample.rotation};
    } else {
      now = pose_of(mount.mesh, snapshot.states[mount.surface].positions);
    }
    frame::Camera& camera = snapshot.cameras[mount.camera];
    const scene::Pose& start = mount.parent.start;
    const Quat turn = mount.follows_rotation ? now.rotation * start.rotation.conjugate() : Quat::Identity();
    for (Vec3* point : {&camera.position, &camera.target}) *point = now.position + turn * (*point - start.position);
  }
}

}  // namespace weft::production
