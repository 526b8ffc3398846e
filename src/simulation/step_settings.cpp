#include "simulation/step_settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace weft::simulation {

integrator::Method method_of(scene::Integrator integrator) {
  switch (integrator) {
    case scene::Integrator::implicit_euler:
      return integrator::Method::implicit_euler;
    case scene::Integrator::implicit_midpoint:
      return integrator::Method::implicit_midpoint;
    case scene::Integrator::bdf2:
      return integrator::Method::bdf2;
  }
  return integrator::Method::implicit_euler;
}

integrator::NewtonParameters newton_of(const scene::Scene& scene) {
  return {scene.solver.newton_tolerance, scene.solver.newton_iterations, scene.solver.linear_tolerance,
          scene.solver.linear_iterations, scene.time.tolerance.value_or(0)};
}

std::optional<integrator::StepControl> step_control_of(const scene::Scene& scene) {
  if (!scene.time.tolerance) return std::nullopt;
  // Without a history, the error in free fall is estimated as that of implicit Euler: ½ h² g (BDF2: 3/2 of it).
  const double first = std::sqrt(2 * *scene.time.tolerance / std::max(scene.physics.largest_gravity(), 1.0));
  return integrator::StepControl(method_of(scene.time.integrator), *scene.time.tolerance, first);
}

std::vector<Index> first_particles(const ClothSystem& cloth) {
  std::vector<Index> first;
  for (std::size_t c = 0; c < cloth.cloths(); ++c) first.push_back(cloth.first_particle(c));
  return first;
}

namespace {

// Times that differ by less count as equal [s].
constexpr double kSameTime = 1e-9;

// Velocities of the frame particles of a body as its keys move it at t; if the body is free, plus its own velocity and
// spin.
std::array<Vec3, mesh::RigidFrame::kParticles> velocities_of_frame(const environment::Environment& environment,
                                                                   std::size_t number, double t, bool is_free) {
  const environment::Dynamics& body = *environment.bodies[number].dynamics;
  const environment::PoseSample pose = environment.pose(number, t);
  std::array<Vec3, mesh::RigidFrame::kParticles> velocities;
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    const Vec3& particle = body.frame.particles()[k];
    velocities[k] = pose.velocity_at(pose.rotation * particle);
    if (is_free)
      velocities[k] += body.velocity + body.angular_velocity.cross(pose.rotation * (particle - body.frame.centre()));
  }
  return velocities;
}

}  // namespace

SystemState start_of(const scene::Scene& scene, const environment::Environment& environment, const ClothSystem& cloth,
                     double t) {
  SystemState start;
  start.bodies_time = t;
  for (std::size_t c = 0; c < environment.cloths.size(); ++c) {
    const environment::ClothObject& object = environment.cloths[c];
    start.x.insert(start.x.end(), object.start.begin(), object.start.end());
    start.v.insert(start.v.end(), object.start.size(), object.velocity);
    if (scene.cloths[c].spin == Vec3::Zero()) continue;
    const std::size_t first = start.v.size() - object.start.size();
    Vec3 middle = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = first; i < start.v.size(); ++i) {
      mass += cloth.masses()[i];
      middle += cloth.masses()[i] * start.x[i];
    }
    middle /= mass;
    const Vec3 rate = std::numbers::pi / 180 * scene.cloths[c].spin;
    for (std::size_t i = first; i < start.v.size(); ++i) start.v[i] += rate.cross(start.x[i] - middle);
  }
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) {
    if (!environment.bodies[b].dynamics) continue;
    const environment::PoseSample pose = environment.pose(b, t);
    for (const Vec3& particle : environment.bodies[b].dynamics->frame.particles())
      start.x.push_back(pose.position + pose.rotation * particle);
    const bool is_free = t >= environment.bodies[b].dynamics->release;
    for (const Vec3& v : velocities_of_frame(environment, b, t, is_free)) start.v.push_back(v);
  }
  return start;
}

void hold_frames(const environment::Environment& environment, const ClothSystem& cloth, double t,
                 std::vector<integrator::HeldParticle>& held) {
  const std::vector<Index> first_of_frames = cloth.first_of_frames(environment);
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) {
    const environment::Dynamics* body = environment.bodies[b].dynamics.get();
    if (body == nullptr || t > body->release + kSameTime) continue;
    const environment::PoseSample pose = environment.pose(b, t);
    for (std::size_t k = 0; k < mesh::RigidFrame::kParticles; ++k) {
      const Vec3 arm = pose.rotation * body->frame.particles()[k];
      held.push_back({{first_of_frames[b] + static_cast<Index>(k)}, pose.position + arm, pose.velocity_at(arm)});
    }
  }
}

bool release_frames(const environment::Environment& environment, const ClothSystem& cloth, double t, double h,
                    std::span<Vec3> v) {
  const std::vector<Index> first_of_frames = cloth.first_of_frames(environment);
  bool any = false;
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) {
    const environment::Dynamics* body = environment.bodies[b].dynamics.get();
    const auto is_held_until = [&](double end) { return end <= body->release + kSameTime; };
    if (body == nullptr || !is_held_until(t) || is_held_until(t + h)) continue;
    std::ranges::copy(velocities_of_frame(environment, b, t, true), v.begin() + first_of_frames[b]);
    any = true;
  }
  return any;
}

bool frames_are_constant(const environment::Environment& environment, double t0, double t1) {
  return std::ranges::none_of(environment.bodies, [&](const environment::BodyObject& body) {
    return body.dynamics && t0 < body.dynamics->release && (body.moving || t1 > body.dynamics->release);
  });
}

}  // namespace weft::simulation
