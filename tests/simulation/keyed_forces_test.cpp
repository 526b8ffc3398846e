// Compares forces that change with time and place, and an initial spin, with theory.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "film/production/plan.hpp"
#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

Vec3 mean_velocity(const production::SceneSimulation& simulation) {
  const ParticleState state = simulation.state();
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < state.masses.size(); ++i)
    momentum += state.masses[i] * state.velocities[i], mass += state.masses[i];
  return momentum / mass;
}

Vec3 velocity_at_end(const scene::Scene& scene) {
  production::SceneSimulation simulation(scene);
  for (int frame = 1; frame < scene.frame_count(); ++frame) simulation.advance();
  return mean_velocity(simulation);
}

TEST(KeyedForces, GravityThatGrowsAddsItsIntegralToTheVelocity) {
  scene::Scene scene = testing::sheet_alone(0.3, 5, 0);
  scene.time.integrator = scene::Integrator::implicit_midpoint;
  scene.physics.interpolation = scene::Interpolation::linear;
  scene.physics.keys = {{0.2, {0, 0, 0}, {0, 0, 0}}, {0.8, {0, 3, -6}, {0, 0, 0}}};
  // The midpoint rule is exact for accelerations that are linear in time: the last key acts for ½ · 0.6 s + 0.2 s = 0.5
  // s.
  EXPECT_LT((velocity_at_end(scene) - 0.5 * Vec3(0, 3, -6)).norm(), 1e-9);
}

TEST(KeyedForces, EnergiesOfTheStartAreThoseOfItsGravity) {
  scene::Scene scene = testing::sheet_alone(0.3, 5, 1);
  scene.time.preroll = 0.2;
  scene.physics.keys = {{-0.2, {0, 0, -2}, {0, 0, 0}}, {0, {0, 0, -10}, {0, 0, 0}}};
  const FrameReport start = production::SceneSimulation(scene).initial_report();
  EXPECT_EQ(start.frame, -5);
  EXPECT_EQ(start.time, -0.2);
  EXPECT_NEAR(start.potential_energy, 0.2 * 0.3 * 0.3 * 2, 1e-12);  // 18 g at 1 m
}

// The sheet falls onto the floor in its first step, which its start does not show: contacts that are found only then
// replace the midpoint rule by Euler's method, whose stage is the end of the step, and so must be its forces.
TEST(KeyedForces, AreThoseOfTheEndOfAStepInWhichContactsAreFound) {
  scene::Scene scene = testing::sheet_alone(0.2, 3, 0.003);
  scene.time = {.duration = 1, .fps = 25, .step = 0.04, .integrator = scene::Integrator::implicit_midpoint};
  scene.solver.newton_tolerance = 1e-3;
  scene.contact.obstacles = true;
  scene.cloths[0].material.thickness = 0.001;
  scene.cloths[0].material.friction = 0;
  scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
  scene.obstacles[0].friction = 0;
  scene.physics.interpolation = scene::Interpolation::linear;
  scene.physics.keys = {{0, {0, 0, -20}, {0, 0, 0}}, {0.04, {4, 0, -20}, {0, 0, 0}}};
  production::SceneSimulation simulation(scene);
  EXPECT_EQ(simulation.advance().steps, 1);
  const std::vector<Vec3>& x = testing::sheet_of(simulation.snapshot());
  EXPECT_GT(testing::lowest(x), 0);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& place : x) middle += place / static_cast<double>(x.size());
  EXPECT_NEAR(middle.x(), 0.04 * 0.04 * 4, 1e-4);
}

// Order of convergence of the position of the last particle at 0.2 s, from runs with steps of 20, 10 and 5 ms.
double order_at_last_particle(scene::Scene scene) {
  testing::solve_tightly(scene);
  scene.time.integrator = scene::Integrator::implicit_midpoint;
  std::vector<Vec3> ends;
  for (const double step : {0.02, 0.01, 0.005}) {
    scene.time.step = step;
    production::SceneSimulation simulation(scene);
    for (int frame = 1; frame <= 5; ++frame) simulation.advance();
    ends.push_back(simulation.state().positions.back());
  }
  return std::log2((ends[0] - ends[1]).norm() / (ends[1] - ends[2]).norm());
}

TEST(KeyedForces, LengthsOfRopesKeepTheSecondOrderOfTheMidpointRule) {
  EXPECT_NEAR(order_at_last_particle(support::scene_of_text(
                  "[physics]\ngravity = [0, 0, 0]\nair_density = 0\n[contact]\nself = false\nobstacles = false\n"
                  "[[rope]]\nname = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 3\ndiameter = 0.006\n"
                  "mass = 0.1\nstretch = 1\nbend = 0\ndamping = 0\npin = [{ at = 0 }]\n"
                  "keys = [{ time = 0, length = 1 }, { time = 1, length = 1.5 }]\n")),
              2, 0.2);
}

// A sheet of four equal particles, which springs pull back with a frequency of 10 rad/s.
TEST(KeyedForces, PinsWithAStrengthKeepTheSecondOrderOfTheMidpointRule) {
  scene::Scene scene = testing::sheet_alone(0.2, 2, 0);
  scene.physics.gravity.setZero();
  scene.cloths[0].velocity = {0, 0, 1};
  scene::Pin pin;
  pin.strength = 100 * 0.2 * 0.2 * 0.2 / 4;
  scene.cloths[0].pins.push_back(pin);
  EXPECT_NEAR(order_at_last_particle(scene), 2, 0.2);
}

TEST(KeyedForces, SheetThatFacesWindFromSomeTimeOnCatchesUpAsTheoryHasIt) {
  scene::Scene scene = testing::sheet_alone(0.3, 5, 0);
  scene.physics.air_density = 1.2;
  scene.physics.gravity.setZero();
  scene.time.duration = 0.6;
  scene.time.step = 0.001;
  scene.physics.interpolation = scene::Interpolation::linear;
  constexpr double kWind = 8;
  scene.physics.keys = {{0.2, {0, 0, 0}, {0, 0, 0}}, {0.2001, {0, 0, 0}, {0, 0, kWind}}};
  // Drag: v' = a (w − v)² with wind w, a = ρ c / (2 σ), air density ρ, coefficient c, density σ; w − v = w / (1 + a w
  // t).
  const double a = 1.2 * scene.cloths[0].material.drag / (2 * scene.cloths[0].material.density);
  EXPECT_NEAR(velocity_at_end(scene).z() / (kWind - kWind / (1 + a * kWind * 0.4)), 1, 0.005);  // measured: 0.002
  scene.time.duration = 0.16;
  EXPECT_EQ(velocity_at_end(scene), Vec3(0, 0, 0));
}

TEST(KeyedForces, FanPushesWhatIsInItsConeWithTheDragOfItsJet) {
  const auto after_a_millisecond = [](double x) {
    scene::Scene scene = testing::sheet_alone(0.02, 3, 1.5);
    scene.cloths[0].pose.position.x() = x;
    scene.physics.air_density = 1.2;
    scene.physics.gravity.setZero();
    scene.time = {.duration = 0.001, .fps = 1000, .step = 0.001};
    scene::Fan fan;
    fan.keys = {{.time = 0, .position = {0, 0, 0}, .direction = {0, 0, 1}, .speed = 6}};
    fan.radius = 0.2;
    scene.fans = {fan};
    return velocity_at_end(scene).z();
  };
  const double apex = 0.2 / std::tan(12 * std::numbers::pi / 180), jet = 6 * apex / (apex + 1.5);
  EXPECT_NEAR(after_a_millisecond(0) / (1e-3 * 1.2 * jet * jet / (2 * 0.2)), 1, 0.03);  // measured: 0.016
  EXPECT_EQ(after_a_millisecond(0.6), 0);
}

TEST(KeyedForces, SpinTurnsClothAboutItsCentreAndIsKept) {
  scene::Scene scene = testing::sheet_alone(0.3, 9, 0.4);
  scene.physics.gravity.setZero();
  scene.time = {.duration = 0.2, .fps = 25, .step = 0.002, .integrator = scene::Integrator::implicit_midpoint};
  scene.cloths[0].spin = {0, 0, 180};
  scene.cloths[0].velocity = {0.5, 0, 0};
  const auto angular_momentum = [](const production::SceneSimulation& simulation) {
    const ParticleState state = simulation.state();
    Vec3 middle = Vec3::Zero(), sum = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = 0; i < state.masses.size(); ++i)
      middle += state.masses[i] * state.positions[i], mass += state.masses[i];
    middle /= mass;
    for (std::size_t i = 0; i < state.masses.size(); ++i)
      sum += state.masses[i] * (state.positions[i] - middle).cross(state.velocities[i]);
    return sum;
  };
  production::SceneSimulation simulation(scene);
  // A square of n × n cells with lumped masses has the moment of inertia m a² / 6 (1 + 2 / n²) about its normal.
  const double inertia = 0.2 * 0.09 * 0.09 / 6 * (1 + 2.0 / 64);
  const Vec3 start = angular_momentum(simulation);
  EXPECT_LT((start - Vec3(0, 0, inertia * std::numbers::pi)).norm(), 1e-12);
  EXPECT_LT((mean_velocity(simulation) - Vec3(0.5, 0, 0)).norm(), 1e-14);
  const Vec3 corner = simulation.state().positions[0];
  for (int frame = 1; frame < scene.frame_count(); ++frame) simulation.advance();
  EXPECT_LT((angular_momentum(simulation) - start).norm(), 0.01 * start.norm());
  // The sheet has turned by 36 degrees and moved by 0.1 m.
  const Vec3 arm = corner - Vec3(0, 0, 0.4), there = simulation.state().positions[0] - Vec3(0.1, 0, 0.4);
  const double angle = std::atan2(arm.cross(there).z(), arm.dot(there)) * 180 / std::numbers::pi;
  EXPECT_NEAR(angle, 36, 1);
}

TEST(PlanOfNamedParts, ListsThemOnlyWhereASceneNamesThem) {
  const auto named = [](const scene::Scene& scene) {
    std::string parts;
    for (const production::PlanItem& item : production::plan(scene))
      for (const char* part : {"pressure", "keyed", "fans", "attachments"})
        if (item.part.find(part) != std::string::npos) parts += item.part + ";";
    return parts;
  };
  scene::Scene scene = testing::sheet_alone(0.3, 5, 0);
  EXPECT_EQ(named(scene), "");
  scene.cloths[0].pressure.value = 3;
  scene.physics.keys = {{0, {0, 0, 0}, {0, 0, 0}}};
  scene.fans.emplace_back();
  scene.attachments.emplace_back();
  EXPECT_EQ(named(scene),
            "force: pressure of enclosed air;force: attachments;force: keyed gravity and wind;force: fans;");
}

}  // namespace
}  // namespace weft::simulation
