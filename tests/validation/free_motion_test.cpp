// Free cloth conserves its momentum. At default settings it falls, and drifts in wind, as a rigid body does.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "film/environment/environment.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/fabrics.hpp"
#include "forces/sheets.hpp"
#include "physics/integrator/stepper.hpp"
#include "physics/model/gusts.hpp"
#include "physics/simulation/step_problem.hpp"
#include "simulation/scenes.hpp"

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
  scene.cloths[0].material.bend_friction = 0;  // its force has a kink at rest, which Newton's method cannot resolve to
                                               // 1e-8
  const model::Model model = environment::Environment(scene).model;
  ClothSystem system(model);
  // At the start, the cloth is crumpled and moves, so that all forces act.
  integrator::State start{model.cloths[0].start, forces::testing::random_vectors(81, 1, 2)};
  const auto noise = forces::testing::random_vectors(81, 0.001, 1);
  for (std::size_t i = 0; i < 81; ++i) start.x[i] += noise[i];
  for (Vec3& v : start.v) v += Vec3(0.5, -0.3, 0.2);
  const Vec3 before = momentum(system.masses(), start.v);
  const double size = 0.2 * 0.2 * 0.2;  // momentum scale: the mass times about 1 m/s

  for (Method method : {Method::implicit_euler, Method::implicit_midpoint, Method::bdf2}) {
    integrator::Stepper stepper(method, {1e-8, 100, 1e-4, 1000});
    StepProblem problem(system);
    integrator::State now = start, next;
    double energy = system.elastic_energy(now.x);
    for (int step = 0; step < 20; ++step) {
      ASSERT_EQ(stepper.step(problem, now, 0.002, Vec3::Zero(), {}, next).verdict, integrator::Verdict::solved);
      stepper.accept(now, next, 0.002);
      std::swap(now, next);
    }
    // Tolerance: each of twenty steps leaves a residual of 1e-8 of the inertia, and the forces reverse all velocities.
    EXPECT_LT((momentum(system.masses(), now.v) - before).norm(), 2e-7 * size) << static_cast<int>(method);
    // The cloth has deformed: it has lost half of its elastic energy.
    EXPECT_LT(system.elastic_energy(now.x), 0.5 * energy);
  }
}

/// Fabric and mesh.
using Cloths = std::tuple<const char*, scene::ClothShape>;
class FreeFall : public ::testing::TestWithParam<Cloths> {};

TEST_P(FreeFall, LeavesAFlatSheetFlatByEveryMethodAtDefaultSettings) {
  for (scene::Integrator integrator : testing::kIntegrators) {
    scene::Scene scene = testing::sheet_alone(1, 21, 0);
    scene.time.step = 0.01;
    scene.time.integrator = integrator;
    scene.cloths[0].shape = std::get<1>(GetParam());
    scene.cloths[0].material = scene::find_fabric(std::get<0>(GetParam()))->material;
    production::SceneSimulation simulation(scene);
    const std::vector<Vec3> start = testing::sheet_of(simulation.snapshot());
    for (int k = 1; k <= 25; ++k) simulation.advance();
    const std::vector<Vec3>& end = testing::sheet_of(simulation.snapshot());
    const double fallen = end[0].z() - start[0].z();
    // For comparison: a solver tolerance relative to the weight would allow deviations of 0.1 to 0.5 m.
    for (std::size_t i = 0; i < end.size(); ++i)
      ASSERT_LT((end[i] - start[i] - Vec3(0, 0, fallen)).norm(), 1e-6) << name_of(integrator) << ' ' << i;
    // Tolerance: after one second, Euler's method is ahead by half a step, which is 1 % of the path.
    EXPECT_NEAR(fallen, -0.5 * 9.81, 0.5 * 9.81 * 0.011);
  }
}

INSTANTIATE_TEST_SUITE_P(, FreeFall,
                         ::testing::Combine(::testing::Values("silk", "cotton", "denim"),
                                            ::testing::Values(scene::ClothShape::quads,
                                                              scene::ClothShape::crossed_triangles)));

TEST(ReleasedCloth, FallsAsFromAStart) {
  // With the history of a body at rest, BDF2 loses half a step of gravity permanently: 20 mm in the 0.4 s of this fall.
  for (scene::Integrator integrator : testing::kIntegrators) {
    scene::Scene scene = testing::sheet_alone(0.3, 5, 0);
    scene.time.step = 0.01;
    scene.time.integrator = integrator;
    scene::Pin pin;
    pin.release = 0.2;
    scene.cloths[0].pins.push_back(pin);
    production::SceneSimulation simulation(scene);
    for (int k = 1; k <= 15; ++k) simulation.advance();
    const double t = 0.4, h = 0.01, g = 9.81;
    double expected = -0.5 * g * t * t;
    if (integrator == scene::Integrator::implicit_euler) expected -= 0.5 * g * h * t;
    if (integrator == scene::Integrator::bdf2) expected -= 0.75 * g * h * h;  // after a first step by Euler's method
    EXPECT_NEAR(testing::sheet_of(simulation.snapshot())[12].z(), expected, 1e-5) << name_of(integrator);
  }
}

/// Speed at which the middle of a sheet of 5 x 5 particles falls in the last of 50 frames [m/s].
double speed_after_two_seconds(const scene::Scene& scene) {
  production::SceneSimulation simulation(scene);
  double before = 0, speed = 0;
  for (int k = 1; k <= 50; ++k) {
    simulation.advance();
    const double z = testing::sheet_of(simulation.snapshot())[12].z();
    speed = 25 * (before - z);
    before = z;
  }
  return speed;
}

TEST(SteadyAir, TerminalVelocityDoesNotDependOnTheStep) {
  for (scene::Integrator integrator : testing::kIntegrators)
    for (double drag : {1.0, 2.0})
      for (double step : {0.04, 0.01, 0.0025}) {
        scene::Scene scene = testing::sheet_alone(0.3, 5, 0);
        scene.time.step = step;
        scene.time.integrator = integrator;
        scene.physics.air_density = 1.2;
        scene.cloths[0].material.drag = drag;
        // m g = ½ ρ c A v² for the terminal speed v. The sheet reaches it within 2 s, at least eleven times v / g.
        const double expected = std::sqrt(2 * scene.cloths[0].material.density * 9.81 / (1.2 * drag));
        EXPECT_NEAR(speed_after_two_seconds(scene), expected, 1e-3 * expected)
            << name_of(integrator) << ' ' << drag << ' ' << step;
      }
}

// The gusts have a size of 1e5 m, so the wind is the same along the sheet's path of two seconds. Relative to this wind,
// the sheet falls as in still air.
TEST(GustsInARun, CarryASheetThatFalls) {
  for (const scene::Integrator integrator : testing::kIntegrators) {
    scene::Scene scene = testing::sheet_alone(0.2, 5, 0);
    scene.time.integrator = integrator;
    scene.physics.air_density = 1.2;
    scene.physics.gusts = {.speed = 1, .size = 1e5, .seed = 3};
    const double gust = model::GustField(scene.physics.gusts, Vec3::Zero()).at(Vec3::Zero(), 1).z();
    ASSERT_GT(std::abs(gust), 0.2) << "something to see";
    const double in_still_air = std::sqrt(2 * scene.cloths[0].material.density * 9.81 / 1.2);
    // Tolerance: over a path of some metres, the wind changes by 1e-4 of its speed.
    EXPECT_NEAR(speed_after_two_seconds(scene), in_still_air - gust, 1e-3 * in_still_air) << name_of(integrator);
  }
}

TEST(SteadyAir, ClothInSteadyWindComesToTheSameRestAtEveryStep) {
  std::vector<double> energies;
  for (double step : {0.04, 0.01, 0.0025}) {
    scene::Scene scene = testing::sheet_alone(0.5, 11, 0);
    scene.time.step = step;
    scene.physics.air_density = 1.2;
    scene.physics.wind = {0, 3, 0};
    scene.cloths[0].material = scene::find_fabric("silk")->material;
    scene.cloths[0].pose.rotation = Quat(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitX()));
    for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
      scene::Pin pin;
      pin.low = pin.high = corner;
      scene.cloths[0].pins.push_back(pin);
    }
    production::SceneSimulation simulation(scene);
    FrameReport report;
    for (int k = 0; k < 100; ++k) report = simulation.advance();
    energies.push_back(report.elastic_energy);
  }
  for (double energy : energies) EXPECT_NEAR(energy, energies.back(), 0.01 * energies.back());
}

}  // namespace
}  // namespace weft::simulation
