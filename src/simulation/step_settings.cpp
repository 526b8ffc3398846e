#include "simulation/step_settings.hpp"

#include <algorithm>
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
  // The first step is one of Euler's, whose error in free fall is ½ h² g.
  const double first = std::sqrt(2 * *scene.time.tolerance / std::max(scene.physics.largest_gravity(), 1.0));
  return integrator::StepControl(method_of(scene.time.integrator), *scene.time.tolerance, first);
}

std::vector<Index> first_particles(const ClothSystem& cloth) {
  std::vector<Index> first;
  for (std::size_t c = 0; c < cloth.cloths(); ++c) first.push_back(cloth.first_particle(c));
  return first;
}

Moment start_of(const scene::Scene& scene, const environment::Environment& environment, const ClothSystem& cloth,
                double t) {
  Moment start;
  start.placed_for = t;
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
  return start;
}

}  // namespace weft::simulation
