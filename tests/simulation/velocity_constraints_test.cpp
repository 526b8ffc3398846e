// Tests the contact response of Etzmuß et al. (2001) in scenes: velocities prescribed in the solver (Eq. (4)).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]

scene::Scene with_velocity_constraints(scene::Scene scene) {
  scene.contact.self = scene.contact.obstacles = true;
  scene.contact.response = scene::Response::velocity_constraints;
  return scene;
}

/// The patch of testing::patch_on_slope(), in steps of 5 ms.
scene::Scene patch_on_slope(double angle, double friction) {
  scene::Scene scene = with_velocity_constraints(testing::patch_on_slope(angle, friction));
  scene.time.step = 0.005;
  return scene;
}

/// Mean position along the slope [m] in each frame.
std::vector<double> distances_down(const scene::Scene& scene, int frames) {
  const Vec3 down = scene.obstacles[0].pose.rotation * Vec3::UnitX();
  std::vector<double> distances;
  for (const auto& frame :
       support::run_scene(scene, {.end = frames + 1, .counts_intersections = false, .keep_positions = true})) {
    double distance = 0;
    for (const Vec3& p : frame.cloths[0]) distance += down.dot(p) / static_cast<double>(frame.cloths[0].size());
    distances.push_back(distance);
  }
  return distances;
}

TEST(VelocityConstraintsInScenes, ClothOnAPlaneRestsWithoutDrift) {
  const auto frames =
      support::run_scene(patch_on_slope(std::atan(0.98 * 0.4), 0.4), {.end = 51, .keep_positions = true});
  for (const auto& frame : frames) EXPECT_EQ(frame.pairs, 0u);
  double furthest = 0, moved = 0;
  for (std::size_t i = 0; i < frames[0].cloths[0].size(); ++i) {
    furthest = std::max(furthest, (frames[50].cloths[0][i] - frames[0].cloths[0][i]).norm());
    moved = std::max(moved, (frames[50].cloths[0][i] - frames[25].cloths[0][i]).norm());
  }
  // The patch slides for one or two steps, until the normal force that limits friction is known.
  EXPECT_LT(furthest, 2e-4);
  // A sticking patch does not move; with springs it creeps by up to 1e-4 m in this time.
  EXPECT_LT(moved, 1e-9);
}

TEST(VelocityConstraintsInScenes, ClothSlidesDownASlopeAsCoulombSays) {
  const double mu = 0.4, angle = std::atan(1.25 * mu);
  const auto distance = distances_down(patch_on_slope(angle, mu), 30);
  const double acceleration = 50 * ((distance[30] - distance[29]) - (distance[15] - distance[14])) / 0.3;
  const double expected = kGravity * (std::sin(angle) - mu * std::cos(angle));
  EXPECT_NEAR(acceleration, expected, 0.02 * expected);
}

TEST(VelocityConstraintsInScenes, ClothIsReleasedWhereItIsLifted) {
  // Pins lift one edge; the rest of the cloth leaves the floor freely.
  scene::Scene scene = with_velocity_constraints(testing::sheet_alone(0.2, 11, 0.001));
  scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
  scene::Pin pin;
  pin.high = {0, 1};
  pin.motion.keys = {{0.2, {}}, {0.8, {{0, 0, 0.3}, Quat::Identity()}}};
  scene.cloths[0].pins = {pin};
  scene.time.duration = 2;
  const auto frames = support::run_scene(scene);
  for (const auto& frame : frames) {
    EXPECT_EQ(frame.pairs, 0u);
    EXPECT_LT(frame.max_stretch, 1.05);
  }
  EXPECT_GT(testing::lowest(frames.back().cloths[0]), 0.09);
  EXPECT_EQ(frames.back().report.constraints, 11);
}

TEST(VelocityConstraintsInScenes, AMovingObstacleCarriesCloth) {
  scene::Scene scene = with_velocity_constraints(testing::sheet_alone(0.2, 11, 0.101));
  scene.obstacles.push_back(testing::obstacle("lift", scene::BoxShape{{0.4, 0.4, 0.2}, 0}));
  scene.obstacles[0].motion.keys = {{0, {}}, {1, {{0.1, 0, 0.2}, Quat::Identity()}}};
  scene.cloths[0].material.friction = scene.obstacles[0].friction = 1;
  const auto frames = support::run_scene(scene, {.keep_positions = true});
  for (const auto& frame : frames) EXPECT_EQ(frame.pairs, 0u);
  for (std::size_t i = 0; i < frames[0].cloths[0].size(); ++i) {
    const Vec3 displacement = frames.back().cloths[0][i] - frames[0].cloths[0][i];
    EXPECT_LT((displacement - Vec3(0.1, 0, 0.2)).norm(), 1e-3);
  }
}

/// A patch of 0.15 m rests on a plane that moves by `keys`.
scene::Scene patch_on_tray(double friction, std::vector<scene::PoseKey> keys) {
  scene::Scene scene = with_velocity_constraints(testing::sheet_alone(0.15, 8, 0.0012));
  scene.contact.self = false;
  scene.time.step = 0.01;
  scene.cloths[0].material.friction = friction;
  scene.cloths[0].material.drag = 0;
  scene.obstacles.push_back(testing::obstacle("tray", scene::Plane{}));
  scene.obstacles[0].friction = friction;
  scene.obstacles[0].motion.keys = std::move(keys);
  scene.obstacles[0].motion.interpolation = scene::Interpolation::linear;
  return scene;
}

// The patch must slip as a whole. If its halves stuck in turn, in alternating steps, it would stay in place (measured:
// up to 40 degrees).
TEST(VelocityConstraintsInScenes, ClothOnATiltingTraySlipsAsABlockDoes) {
  constexpr double kTurn = 10 * std::numbers::pi / 180;  // [rad/s]; the tray turns from 0.4 s on
  for (double mu : {0.1, 0.3, 0.6}) {
    scene::Scene scene = patch_on_tray(
        mu, {{0, {}}, {0.4, {}}, {4.4, {Vec3::Zero(), Quat(Eigen::AngleAxisd(4 * kTurn, Vec3::UnitY()))}}});
    const auto frames = support::run_scene(scene, {.end = 111, .counts_intersections = false, .keep_positions = true});
    double distance = 0, speed = 0;  // of a block along the tray [m], [m/s], with far shorter steps
    const double h = 1e-5;
    for (int step = 0; step < 440000; ++step) {
      const double angle = kTurn * std::max(0.0, step * h - 0.4);
      const double load = kGravity * std::cos(angle) - 2 * kTurn * speed;
      speed = std::max(0.0, speed + h * (kGravity * std::sin(angle) + kTurn * kTurn * distance - mu * load));
      distance += h * speed;
      if ((step + 1) % 4000 != 0) continue;
      const auto& x = frames[static_cast<std::size_t>((step + 1) / 4000)].cloths[0];
      const Vec3 down(std::cos(angle), 0, -std::sin(angle));
      double of_patch = 0;
      for (const Vec3& point : x) of_patch += down.dot(point) / static_cast<double>(x.size());
      // Tolerance: implicit Euler is ahead by half a step times the speed; sliding begins up to half a degree (0.05 s)
      // late.
      EXPECT_NEAR(of_patch, distance, 0.02 * distance + 0.05 * speed + 0.001)
          << "friction " << mu << ", " << angle / kTurn * 10 << " degrees";
    }
  }
}

// A tray starts with a constant acceleration, approximated by linear motion between key frames every 10 ms.
TEST(VelocityConstraintsInScenes, ClothOnATrayThatStartsLagsAsABlockDoes) {
  constexpr double kMu = 0.3;
  for (double acceleration : {0.9 * kMu * kGravity, 1.1 * kMu * kGravity, 2 * kMu * kGravity}) {
    std::vector<scene::PoseKey> keys;
    for (int k = 0; k <= 100; ++k) {
      const double t = 0.01 * k, since = std::max(0.0, t - 0.2);
      keys.push_back({t, {{0.5 * acceleration * since * since, 0, 0}, Quat::Identity()}});
    }
    const auto frames = support::run_scene(patch_on_tray(kMu, keys), {.end = 26, .counts_intersections = false});
    double distance = 0;
    for (const Vec3& x : frames.back().cloths[0])
      distance += x.x() / static_cast<double>(frames.back().cloths[0].size());
    const double expected = 0.5 * std::min(acceleration, kMu * kGravity) * 0.8 * 0.8;
    // Tolerance: Euler's method adds half of the last step's motion, 1.25 %, and half of the tray's first step, 2.5 %.
    EXPECT_NEAR(distance, expected, 0.04 * expected) << acceleration << " m/s²";
  }
}

TEST(VelocityConstraintsInScenes, ClothThatMeetsClothKeepsItsMomentum) {
  // Contacts between cloths are springs also with velocity constraints.
  scene::Scene scene = with_velocity_constraints(testing::sheet_alone(0.2, 11, 0));
  scene.physics.gravity = Vec3::Zero();
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].name = "other";
  scene.cloths[1].pose.position = {0.003, 0.002, 0.02};
  scene.cloths[1].velocity = {0, 0, -0.5};
  scene.cloths[1].material.density = scene.cloths[0].material.density;
  testing::solve_tightly(scene);
  scene.solver.halvings = 4;
  scene.time.duration = 0.4;
  const auto frames = support::run_scene(scene, {.keep_positions = true});
  for (const auto& frame : frames) EXPECT_EQ(frame.pairs, 0u);
  const auto middle = [](const std::vector<Vec3>& x) {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      // Lumped masses: half at the sides, a quarter at the corners.
      const double mass_ratio = (i % 11 % 10 == 0 ? 0.5 : 1) * (i / 11 % 10 == 0 ? 0.5 : 1);
      sum += mass_ratio * x[i];
      total += mass_ratio;
    }
    return Vec3(sum / total);
  };
  const auto both = [&](std::size_t k) { return Vec3(middle(frames[k].cloths[0]) + middle(frames[k].cloths[1])); };
  EXPECT_GT((middle(frames[10].cloths[0]) - middle(frames[0].cloths[0])).norm(), 0.01);  // the first cloth was pushed
  EXPECT_LT((both(10) - both(9) - (both(1) - both(0))).norm(), 1e-6 * (both(1) - both(0)).norm());
}

TEST(VelocityConstraintsInScenes, NothingIntersectsAndADrapeComesToRest) {
  for (double step : {0.01, 0.02, 0.04}) {
    scene::Scene scene = with_velocity_constraints(testing::sheet_alone(0.5, 17, 0.2));
    scene.physics.air_density = 1.2;
    scene.cloths[0].pose.position += Vec3(0.003, 0.002, 0);
    scene.obstacles.push_back(testing::obstacle("ball", scene::Sphere{0.08}, {0, 0, 0.082}));
    scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
    scene.time.duration = 6;
    scene.time.step = step;
    int steps = 0, iterations = 0;  // in frames from 120 on, in which the cloth rests
    for (const auto& frame : support::run_scene(scene)) {
      EXPECT_EQ(frame.pairs, 0u) << frame.between << " in frame " << frame.report.frame << " at " << step << " s";
      if (frame.report.frame >= 120) {
        // A fold topples before frame 140, at 6.6 mm/s. Then it creeps at 0.7 to 0.8 mm/s, which is invisible.
        EXPECT_LT(frame.rms_speed, frame.report.frame < 140 ? 8e-3 : 1e-3)
            << "in frame " << frame.report.frame << " at " << step << " s";
        steps += frame.report.steps;
        iterations += frame.report.newton_iterations;
      }
    }
    // Measured iterations per step: 2.1 or 3.2, depending on the remaining fold; 13 at 40 ms if steps did not start
    // with the walls of the previous step.
    EXPECT_LT(iterations, 4 * steps) << "at " << step << " s";
  }
}

}  // namespace
}  // namespace weft::simulation
