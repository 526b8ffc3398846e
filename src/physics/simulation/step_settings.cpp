#include "physics/simulation/step_settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/simulation/step_end_motion.hpp"

namespace weft::simulation {

integrator::NewtonParameters newton_of(const model::Model& model) {
  return {model.solver.newton_tolerance, model.solver.newton_iterations, model.solver.linear_tolerance,
          model.solver.linear_iterations, model.time.tolerance.value_or(0)};
}

std::optional<integrator::StepControl> step_control_of(const model::Model& model) {
  if (!model.time.tolerance) return std::nullopt;
  // The first step has no history, so its error is estimated as that of implicit Euler (BDF2: 3/2 of it). In free fall,
  // Euler's estimate is ½ h² g, which equals the tolerance for h = `first`.
  const double first = std::sqrt(2 * *model.time.tolerance / std::max(model.physics.largest_gravity(), 1.0));
  return integrator::StepControl(model.time.integrator, *model.time.tolerance, first);
}

std::vector<Index> first_particles(const ClothSystem& cloth) {
  std::vector<Index> first;
  for (std::size_t c = 0; c < cloth.cloths(); ++c) first.push_back(cloth.first_particle(c));
  return first;
}

namespace {

// Whether keys hold a dynamic body in a step that ends at t [s].
bool is_held_until(const model::Dynamics& body, double t) {
  return !model::is_later(t, body.release);
}

bool is_released(const model::Body& body, double t, double h) {
  return body.dynamics && is_held_until(*body.dynamics, t) && !is_held_until(*body.dynamics, t + h);
}

using FrameVelocities = std::array<Vec3, mesh::RigidFrame::kParticles>;

// Velocities of the frame particles of a body that moves as `pose`. If `is_free` (forces move the
// body), adds the velocities of model::Dynamics.
FrameVelocities velocities_of_frame(const model::Dynamics& body, const motion::PoseSample& pose, bool is_free) {
  FrameVelocities velocities;
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    const Vec3& particle = body.frame.particles()[k];
    velocities[k] = pose.velocity_at(pose.rotation * particle);
    if (is_free)
      velocities[k] += body.velocity + body.angular_velocity.cross(pose.rotation * (particle - body.frame.centre()));
  }
  return velocities;
}

motion::PoseSample pose_at_step_end(const model::Model& model, std::size_t body, double t) {
  return sample_at_step_end(t, [&](double time) { return model.pose(body, time); });
}

}  // namespace

SystemState start_of(const model::Model& model, const ClothSystem& cloth, double t) {
  SystemState start;
  start.bodies_time = t;
  for (std::size_t c = 0; c < model.cloths.size(); ++c) {
    const model::Cloth& object = model.cloths[c];
    start.x.insert(start.x.end(), object.start.begin(), object.start.end());
    start.v.insert(start.v.end(), object.start.size(), object.velocity);
    if (object.spin == Vec3::Zero()) continue;
    const std::size_t first = start.v.size() - object.start.size();
    Vec3 middle = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = first; i < start.v.size(); ++i) {
      mass += cloth.masses()[i];
      middle += cloth.masses()[i] * start.x[i];
    }
    middle /= mass;
    const Vec3& rate = object.spin;
    for (std::size_t i = first; i < start.v.size(); ++i) start.v[i] += rate.cross(start.x[i] - middle);
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!model.bodies[b].dynamics) continue;
    const motion::PoseSample pose = model.pose(b, t);
    for (const Vec3& particle : model.bodies[b].dynamics->frame.particles())
      start.x.push_back(pose.position + pose.rotation * particle);
    const bool is_free = t >= model.bodies[b].dynamics->release;
    for (const Vec3& v : velocities_of_frame(*model.bodies[b].dynamics, pose, is_free)) start.v.push_back(v);
  }
  return start;
}

void hold_frames(const model::Model& model, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held) {
  const std::vector<Index> first_of_frames = cloth.first_of_frames(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const model::Dynamics* body = model.bodies[b].dynamics.get();
    if (body == nullptr || !is_held_until(*body, t)) continue;
    const motion::PoseSample pose = pose_at_step_end(model, b, t);
    for (std::size_t k = 0; k < mesh::RigidFrame::kParticles; ++k) {
      const Vec3 arm = pose.rotation * body->frame.particles()[k];
      held.push_back({{first_of_frames[b] + static_cast<Index>(k)}, pose.position + arm, pose.velocity_at(arm)});
    }
  }
}

bool any_frame_is_released(const model::Model& model, double t, double h) {
  return std::ranges::any_of(model.bodies, [&](const model::Body& body) { return is_released(body, t, h); });
}

void release_frames(const model::Model& model, const ClothSystem& cloth, double t, double h, std::span<Vec3> v) {
  const std::vector<Index> first_of_frames = cloth.first_of_frames(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!is_released(model.bodies[b], t, h)) continue;
    const model::Dynamics& body = *model.bodies[b].dynamics;
    // A body that is released at its last key keeps its motion; one that is released later has come to rest.
    const bool now = std::abs(t - body.release) <= model::kSameTime;
    const motion::PoseSample pose = now ? pose_at_step_end(model, b, t) : model.pose(b, t);
    std::ranges::copy(velocities_of_frame(body, pose, true), v.begin() + first_of_frames[b]);
  }
}

bool frames_are_constant(const model::Model& model, double t0, double t1) {
  return std::ranges::none_of(model.bodies, [&](const model::Body& body) {
    return body.dynamics && is_held_until(*body.dynamics, t0) && (body.may_move || !is_held_until(*body.dynamics, t1));
  });
}

}  // namespace weft::simulation
