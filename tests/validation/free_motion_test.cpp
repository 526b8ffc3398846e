// Cloth by itself keeps what mechanics says it keeps.
#include <gtest/gtest.h>

#include "environment/environment.hpp"
#include "forces/sheets.hpp"
#include "integrator/stepper.hpp"
#include "simulation/scenes.hpp"
#include "simulation/step_problem.hpp"

namespace weft::simulation {
namespace {

using integrator::Method;

Vec3 momentum(std::span<const double> masses, const std::vector<Vec3>& v) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) sum += masses[i] * v[i];
  return sum;
}

TEST(FreeCloth, KeepsItsMomentumInEveryMethod) {
  scene::Scene scene = testing::sheet_alone(0.2, 9, 0);
  scene.cloths[0].material.stretch_viscosity = scene.cloths[0].material.shear_viscosity = 0.5;
  scene.cloths[0].material.bend_viscosity = 1e-6;
  scene.cloths[0].material.bend_friction = 0;  // Newton does not resolve its kink at rest to 1e-8
  const environment::Environment environment(scene);
  ClothSystem system(scene, environment);
  // Crumpled and in motion, so that all forces act.
  integrator::State start{environment.cloths[0].start, forces::testing::random_vectors(81, 1, 2)};
  const auto noise = forces::testing::random_vectors(81, 0.001, 1);
  for (std::size_t i = 0; i < 81; ++i) start.x[i] += noise[i];
  for (Vec3& v : start.v) v += Vec3(0.5, -0.3, 0.2);
  const Vec3 before = momentum(system.masses(), start.v);
  const double size = 0.2 * 0.2 * 0.2;  // mass, at about 1 m/s

  for (Method method : {Method::implicit_euler, Method::implicit_midpoint, Method::bdf2}) {
    integrator::Stepper stepper(method, {1e-8, 100, 1e-4, 1000});
    StepProblem problem(system);
    integrator::State now = start, next;
    double energy = system.elastic_energy(now.x);
    for (int step = 0; step < 20; ++step) {
      ASSERT_EQ(stepper.step(problem, now, 0.002, Vec3::Zero(), {}, next).verdict, integrator::Verdict::solved);
      stepper.accept(now, 0.002);
      std::swap(now, next);
    }
    // A residual of 1e-8 of the inertia in each of twenty steps, during which the forces turn all velocities round.
    EXPECT_LT((momentum(system.masses(), now.v) - before).norm(), 2e-7 * size) << static_cast<int>(method);
    // The motion was not just a translation.
    EXPECT_LT(system.elastic_energy(now.x), 0.5 * energy);
  }
}

}  // namespace
}  // namespace weft::simulation
