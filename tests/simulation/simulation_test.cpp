// Tests of the whole step loop: pins, contact, and the same bits with any number of threads.
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "core/parallel.hpp"
#include "core/stop.hpp"
#include "film/production/plan.hpp"
#include "film/production/scene_simulation.hpp"
#include "physics/motion/track.hpp"
#include "simulation/scenes.hpp"
#include "support/intersections.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

using testing::lowest;
using testing::obstacle;
using testing::sheet_alone;
using testing::sheet_of;

// A sheet of 0.6 m falls on a ball and down its sides.
scene::Scene sheet_on_ball() {
  scene::Scene scene = sheet_alone(0.6, 21, 0.26);
  scene.contact.self = scene.contact.obstacles = true;
  scene.obstacles.push_back(obstacle("ball", scene::Sphere{0.25}));
  scene.obstacles.back().segments = 24;
  return scene;
}

TEST(Simulation, FrameZeroIsTheSheetAsTheSceneLaysIt) {
  scene::Scene scene = sheet_alone(0.4, 5, 1.5);
  const production::SceneSimulation simulation(scene);
  EXPECT_EQ(simulation.snapshot()->frame, 0);
  EXPECT_EQ(simulation.snapshot()->time, 0);
  ASSERT_EQ(simulation.particles(), 25u);
  const auto& x = sheet_of(simulation.snapshot());
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) EXPECT_LT((x[i + 5 * j] - Vec3(-0.2 + 0.1 * i, -0.2 + 0.1 * j, 1.5)).norm(), 1e-15);
  EXPECT_NEAR(simulation.initial_report().elastic_energy, 0, 1e-20);
  EXPECT_EQ(simulation.initial_report().kinetic_energy, 0);
}

TEST(Simulation, FrameTimesAreThoseOfTheRateAndNoSums) {
  scene::Scene scene = sheet_alone(0.4, 3, 1);
  scene.time.fps = 30;
  scene.time.step = 0.01;  // a frame has 3.3 such steps, so it is divided into four equal ones
  production::SceneSimulation simulation(scene);
  for (int k = 1; k <= 20; ++k) {
    const FrameReport report = simulation.advance();
    EXPECT_EQ(report.frame, k);
    EXPECT_EQ(report.time, k / 30.0);
    EXPECT_EQ(report.steps, 4);
    EXPECT_EQ(report.rejected_steps, 0);
    EXPECT_EQ(simulation.snapshot()->frame, k);
    EXPECT_EQ(simulation.snapshot()->time, k / 30.0);
  }
}

TEST(Simulation, FreeFallInVacuumIsTheLawOfTheMethodForEveryParticle) {
  for (scene::Integrator integrator : testing::kIntegrators) {
    scene::Scene scene = sheet_alone(0.5, 9, 3);
    testing::solve_tightly(scene);
    scene.time.integrator = integrator;
    scene.cloths[0].velocity = {0.5, 0, 1};
    production::SceneSimulation simulation(scene);
    const auto start = sheet_of(simulation.snapshot());
    const double h = 0.02;
    for (int k = 1; k <= 10; ++k) {
      simulation.advance();
      const int n = 2 * k;
      const double t = n * h;
      Vec3 fall = t * scene.cloths[0].velocity + 0.5 * t * t * scene.physics.gravity;
      if (integrator == scene::Integrator::implicit_euler) fall += 0.5 * h * t * scene.physics.gravity;
      if (integrator == scene::Integrator::bdf2) fall += 0.75 * h * h * (1 - std::pow(3, -n)) * scene.physics.gravity;
      const auto& x = sheet_of(simulation.snapshot());
      for (std::size_t i = 0; i < x.size(); ++i)
        // Tolerance: a residual of 1e-9 of the weight in each step moves a particle by up to 1e-9 · ½ g t² = 8e-10 m.
        ASSERT_LT((x[i] - start[i] - fall).norm(), 4e-9) << "frame " << k << ", particle " << i;
    }
  }
}

TEST(Simulation, PinnedParticlesFollowTheKeysExactly) {
  scene::Scene scene = sheet_alone(0.4, 7, 1);
  scene.time.fps = 20;
  scene::Pin pin;
  pin.low = {0, 1};
  pin.motion.interpolation = scene::Interpolation::linear;
  const Quat quarter(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  pin.motion.keys = {{0, {}}, {0.25, {{0.1, 0, 0.2}, Quat::Identity()}}, {0.5, {{0.1, 0.3, 0.2}, quarter}}};
  scene.cloths[0].pins.push_back(pin);
  production::SceneSimulation simulation(scene);
  const auto start = sheet_of(simulation.snapshot());
  const Vec3 centre(0, 0.2, 1);  // of the pinned edge
  for (int k = 1; k <= 12; ++k) {
    simulation.advance();
    const auto& x = sheet_of(simulation.snapshot());
    const double t = k / 20.0;
    // The keys are at frames 5 and 10; after the last key the edge stays.
    const double first = std::min(t / 0.25, 1.0), second = std::clamp(t / 0.25 - 1, 0.0, 1.0);
    const Vec3 displacement = first * Vec3(0.1, 0, 0.2) + second * Vec3(0, 0.3, 0);
    const Eigen::AngleAxisd turn(second * std::numbers::pi / 2, Vec3::UnitZ());
    for (std::size_t i = 42; i < 49; ++i)
      EXPECT_LT((x[i] - (centre + displacement + turn * (start[i] - centre))).norm(), 1e-14) << "frame " << k;
    if (k == 2) {
      EXPECT_LT(x[0].z(), 1 - 0.01);  // the free part falls until the edge pulls it along
    }
  }
}

TEST(Simulation, WithoutRigidityThereIsNoBendingAtAll) {
  // A sheet hangs from one corner, so that all of it bends.
  const auto end_with = [](scene::ClothShape shape, double rigidity, double damping) {
    scene::Scene scene = sheet_alone(0.2, 5, 0);
    scene.cloths[0].shape = shape;
    scene.cloths[0].pins = {scene::Pin{}};
    scene.cloths[0].pins[0].high = {0, 0};
    scene::Material& material = scene.cloths[0].material;
    material.bend = rigidity;
    material.bend_viscosity *= damping, material.bend_friction *= damping;
    for (const production::PlanItem& item : production::plan(scene)) {
      if (item.part == "force: bending") {
        EXPECT_EQ(item.used, rigidity > 0);
      }
      if (item.part == "force: viscosity" || item.part == "force: bending friction") {
        EXPECT_EQ(item.used, rigidity > 0 && damping > 0) << item.part;
      }
    }
    production::SceneSimulation simulation(scene);
    for (int k = 0; k < 5; ++k) simulation.advance();
    return sheet_of(simulation.snapshot());
  };
  for (scene::ClothShape shape : {scene::ClothShape::quads, scene::ClothShape::crossed_triangles}) {
    EXPECT_EQ(end_with(shape, 0, 1), end_with(shape, 0, 0));
    EXPECT_NE(end_with(shape, 5e-5, 1), end_with(shape, 5e-5, 0));
  }
}

TEST(Simulation, PinLetsGoAtItsReleaseTime) {
  scene::Scene scene = sheet_alone(0.2, 3, 1);
  scene::Pin pin;  // holds the whole sheet
  pin.release = 0.2;
  scene.cloths[0].pins.push_back(pin);
  production::SceneSimulation simulation(scene);
  const auto start = sheet_of(simulation.snapshot());
  for (int k = 1; k <= 5; ++k) {
    EXPECT_EQ(simulation.advance().constraints, 9);
    EXPECT_EQ(sheet_of(simulation.snapshot()), start);
  }
  EXPECT_EQ(simulation.advance().constraints, 0);
  // Fall in the two Euler steps after the release. Tolerance: the residual of the solver.
  const double fall = 9.81 * 0.02 * 0.02 * 3;
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_NEAR(start[i].z() - sheet_of(simulation.snapshot())[i].z(), fall, 0.1 * fall);
}

TEST(Simulation, PinThatFollowsAnObstacleMovesWithIt) {
  scene::Scene scene = sheet_alone(0.4, 5, 1);
  scene.obstacles.push_back(obstacle("bar", scene::BoxShape{{0.1, 0.1, 0.1}}, {0, 0.3, 1}));
  scene.obstacles[0].collide = false;
  scene.obstacles[0].motion.interpolation = scene::Interpolation::linear;
  const Quat turned(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
  scene.obstacles[0].motion.keys = {{0, {{0, 0.3, 1}, Quat::Identity()}}, {0.4, {{0.2, 0.4, 1.1}, turned}}};
  scene::Pin pin;
  pin.low = {0, 1};
  pin.follow = "bar";
  scene.cloths[0].pins.push_back(pin);
  production::SceneSimulation simulation(scene);
  const auto start = sheet_of(simulation.snapshot());
  for (int k = 1; k <= 10; ++k) simulation.advance();
  for (std::size_t i = 20; i < 25; ++i) {
    const Vec3 expected = Vec3(0.2, 0.4, 1.1) + turned * (start[i] - Vec3(0, 0.3, 1));
    EXPECT_LT((sheet_of(simulation.snapshot())[i] - expected).norm(), 1e-14);
  }
}

TEST(Simulation, SurfacesKnowAllPlacesToWhichKeysMoveThem) {
  scene::Scene scene = sheet_alone(0.4, 3, 1);
  scene.time.duration = 1;
  scene.obstacles.push_back(obstacle("ball", scene::Sphere{0.1}));
  scene.obstacles.back().motion.keys = {{0, {{0, 0, 0}, Quat::Identity()}}, {1, {{2, 0, 0}, Quat::Identity()}}};
  const frame::SnapshotPtr snapshot = production::SceneSimulation(scene).snapshot();
  const auto& surfaces = snapshot->surfaces;
  EXPECT_NEAR(surfaces[0]->run_bounds->max().z(), 1, 1e-12);
  EXPECT_NEAR(surfaces[1]->run_bounds->min().x(), -0.1, 1e-3);
  EXPECT_NEAR(surfaces[1]->run_bounds->max().x(), 2.1, 1e-3);
}

// A step depends only on its initial state, not on earlier steps of the frame.
TEST(Simulation, EqualStepsLeadToTheSameBitsInFramesOfAnyLength) {
  scene::Scene coarse = sheet_on_ball();
  coarse.time.step = 0.01;
  coarse.time.fps = 25;
  coarse.obstacles[0].motion.keys = {{0, coarse.obstacles[0].pose}, {0.3, coarse.obstacles[0].pose}};
  coarse.obstacles[0].motion.keys[1].pose.position += Vec3(0.05, 0, 0.1);
  scene::Scene fine = coarse;
  fine.time.fps = 100;
  production::SceneSimulation few(coarse), many(fine);
  for (int frame = 1; frame <= 10; ++frame) {
    few.advance();
    for (int k = 0; k < 4; ++k) many.advance();
    ASSERT_EQ(sheet_of(few.snapshot()), sheet_of(many.snapshot())) << "frame " << frame;
  }
  EXPECT_LT(lowest(sheet_of(few.snapshot())), 0.2);  // the sheet has touched the ball
}

TEST(Simulation, SheetOnABallIntersectsNothingInAnyFrame) {
  production::SceneSimulation simulation(sheet_on_ball());
  double lowest_so_far = 1;
  int proximities = 0;
  for (int k = 0; k <= 25; ++k) {
    if (k > 0) proximities += simulation.advance().proximities;
    const auto snapshot = simulation.snapshot();
    EXPECT_EQ(support::find_intersections(support::objects_of(*snapshot)).pairs.size(), 0u) << "frame " << k;
    lowest_so_far = std::min(lowest_so_far, lowest(sheet_of(snapshot)));
  }
  // The sheet fell, and the ball held it up.
  EXPECT_LT(lowest_so_far, 0.1);
  EXPECT_GT(proximities, 1000);
  EXPECT_GT(sheet_of(simulation.snapshot())[220].z(), 0.2);
}

TEST(Simulation, SheetOnABallIsSolvedDownToRounding) {
  scene::Scene scene = sheet_on_ball();
  scene.cloths[0].particles_weft = scene.cloths[0].particles_warp = 9;
  scene.time.step = 0.01;
  scene.solver.newton_tolerance = 1e-8;
  scene.solver.linear_tolerance = 1e-4;
  production::SceneSimulation simulation(scene);
  int rejected = 0;
  for (int k = 0; k < 8; ++k) {
    const FrameReport report = simulation.advance();
    EXPECT_LT(report.solver_error, 1e-9) << "frame " << k + 1;
    rejected += report.rejected_steps;
  }
  EXPECT_LE(rejected, 4);  // measured: 2; 69 if depths of linearisation were accurate to 1e-3 only
}

class EverySearch : public ::testing::TestWithParam<void (*)(scene::Search&)> {};

TEST_P(EverySearch, GivesTheSameBits) {
  scene::Scene scene = sheet_on_ball();
  production::SceneSimulation simulation(scene);
  GetParam()(scene.contact.search);
  production::SceneSimulation other(scene);
  int proximities = 0;
  for (int k = 1; k <= 13; ++k) {
    simulation.advance();
    proximities = other.advance().proximities;
    ASSERT_EQ(sheet_of(other.snapshot()), sheet_of(simulation.snapshot())) << "frame " << k;
  }
  EXPECT_GT(proximities, 50);
}

INSTANTIATE_TEST_SUITE_P(
    Of, EverySearch,
    ::testing::Values([](scene::Search& s) { s.bounds = scene::Bounds::dop18, s.tree = scene::TreeKind::binary; },
                      [](scene::Search& s) { s.bounds = scene::Bounds::dop26, s.tree = scene::TreeKind::quad; },
                      [](scene::Search& s) { s.leaf = 1, s.open_longer_side = true; },
                      [](scene::Search& s) { s.separation_lists = true; },
                      [](scene::Search& s) { s.velocity_cones = true; },
                      [](scene::Search& s) { s.normal_cones = true; }, [](scene::Search& s) { s.reuse = false; }));

// With `coherence`, closest points of an earlier step are reused. So positions differ from those of the default, at
// first in their last digits.
TEST(Simulation, KeptClosestPointsFindTheFirstContactsThatTheDefaultFindsAndKeepTheSheetApart) {
  scene::Scene scene = sheet_on_ball();
  production::SceneSimulation simulation(scene);
  scene.contact.search.coherence = true;
  production::SceneSimulation other(scene);
  int first = 0;  // near pairs in the first frame that has some; later numbers differ
  for (int k = 1; k <= 13; ++k) {
    const int expected = simulation.advance().proximities, found = other.advance().proximities;
    EXPECT_EQ(support::find_intersections(support::objects_of(*other.snapshot())).pairs.size(), 0u) << "frame " << k;
    EXPECT_TRUE(first > 0 || std::abs(found - expected) <= 0.1 * expected) << "frame " << k << ": " << found;
    first = first == 0 ? expected : first;
  }
  EXPECT_GT(first, 0);
}

TEST(Simulation, SheetOnAFloorComesToRestWithinHalfItsThickness) {
  scene::Scene scene = sheet_alone(0.3, 9, 0.05);
  scene.contact.self = scene.contact.obstacles = true;
  scene.obstacles.push_back(obstacle("floor", scene::Plane{}));
  production::SceneSimulation simulation(scene);
  FrameReport report;
  for (int k = 1; k <= 25; ++k) report = simulation.advance();
  const double half_thickness = 0.5 * scene.cloths[0].material.thickness;
  for (const Vec3& x : sheet_of(simulation.snapshot())) {
    EXPECT_GT(x.z(), 0);
    EXPECT_LE(x.z(), half_thickness);
  }
  // Bound for rest [J]: after a fall of one step, the energy would be (g h)² / 2 = 0.02 J/kg.
  const double mass = scene.cloths[0].material.density * 0.3 * 0.3;
  EXPECT_LT(report.kinetic_energy, 1e-6 * mass);
  EXPECT_GT(report.min_distance, 0);
  EXPECT_LE(report.min_distance, half_thickness);
  EXPECT_GT(report.constraints, 0);
}

// FNV-1a hash of all positions of all objects.
std::uint64_t fingerprint(const frame::FrameSnapshot& snapshot) {
  std::uint64_t hash = 14695981039346656037u;
  for (const auto& state : snapshot.states)
    for (const Vec3& x : state.positions)
      for (int axis = 0; axis < 3; ++axis) {
        std::uint64_t bits;
        std::memcpy(&bits, &x[axis], sizeof bits);
        for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 255)) * 1099511628211u;
      }
  return hash;
}

TEST(Simulation, GivesTheSameBitsOnAnyNumberOfThreads) {
  // The sheet has more particles than the grain size of the force loop, and meets the ball in the first frames.
  scene::Scene scene = sheet_on_ball();
  scene.cloths[0].particles_weft = scene.cloths[0].particles_warp = 48;
  std::vector<std::vector<std::uint64_t>> runs;
  for (int threads : {1, 2, 4, 8}) {
    set_thread_count(threads);
    production::SceneSimulation simulation(scene);
    runs.emplace_back();
    int contacts = 0;
    for (int k = 1; k <= 10; ++k) {
      contacts += simulation.advance().constraints;
      runs.back().push_back(fingerprint(*simulation.snapshot()));
    }
    EXPECT_GT(contacts, 0);
  }
  set_thread_count(0);
  EXPECT_NE(runs[0].front(), runs[0].back());
  for (const auto& run : runs) EXPECT_EQ(run, runs[0]);
}

/// Report on a strip of 1 m by 1 mm, ten cells long and held at one end, this number of frames after its release.
FrameReport swinging_strip(scene::Integrator integrator, int particles_across, int frames) {
  scene::Scene scene = testing::sheet_alone(1, 11, 1);
  scene.time.integrator = integrator;
  scene.time.step = 0.01;
  scene::Cloth& cloth = scene.cloths[0];
  cloth.size = {1, 1e-3};
  cloth.particles_warp = particles_across;
  scene::Pin end;
  end.high = {0, 1};
  cloth.pins.push_back(end);
  production::SceneSimulation simulation(scene);
  FrameReport report;
  for (int k = 0; k < frames; ++k) report = simulation.advance();
  return report;
}

TEST(Simulation, NeedlesSwingAsASingleRowOfCells) {
  for (const scene::Integrator integrator : testing::kIntegrators) {
    const FrameReport row = swinging_strip(integrator, 2, 5), needles = swinging_strip(integrator, 101, 5);
    // Measured: energies differ by at most 0.1 %. They would differ by 10 % and more if aggregates were halved along
    // both axes, or if blocks were shifted by 1e-9 of their trace.
    EXPECT_NEAR(needles.kinetic_energy, row.kinetic_energy, 0.01 * row.kinetic_energy);
    EXPECT_NEAR(needles.max_strain, row.max_strain, 0.05 * row.max_strain);
    EXPECT_LT(needles.linear_iterations, 100);
  }
}

// A user may want to see a character or a camera before adding cloth: a scene without mass must run.
TEST(Simulation, BodiesAloneMove) {
  production::SceneSimulation simulation(
      support::scene_of_text("[time]\nduration = 0.2\n[[obstacle]]\nname = 'ball'\nshape = 'sphere'\n"
                             "keys = [{ time = 0, position = [0, 0, 1] }, { time = 0.2, position = [1, 0, 1] }]\n"));
  const double before = simulation.snapshot()->states[0].positions[0].x();
  FrameReport report;
  while (report.time < 0.2 - 1e-9) report = simulation.advance();
  EXPECT_NEAR(simulation.snapshot()->states[0].positions[0].x(), before + 1, 1e-12);
  EXPECT_EQ(report.newton_iterations, 0);
}

TEST(Preroll, IsSimulatedBeforeFrameZeroWhileKeysStand) {
  scene::Scene scene = sheet_alone(0.6, 5, 2);
  scene.obstacles.push_back(obstacle("ball", scene::Sphere{0.25}));
  scene::Obstacle& ball = scene.obstacles[0];
  ball.motion.keys = {{0.2, {{0, 0, 0}, Quat::Identity()}}, {0.6, {{0.3, 0, 0}, Quat::Identity()}}};
  production::SceneSimulation plain(scene);
  for (int k = 1; k <= 5; ++k) plain.advance();

  scene.time.preroll = 0.2;  // five frames
  for (scene::PoseKey& key : ball.motion.keys) key.time -= 0.2;
  production::SceneSimulation shown(scene);
  EXPECT_EQ(shown.snapshot()->frame, -5);
  int asked = 0;
  EXPECT_FALSE(shown.run_preroll([&] { return ++asked <= 2; }));
  EXPECT_TRUE(shown.run_preroll());
  EXPECT_EQ(shown.snapshot()->frame, 0);
  EXPECT_EQ(shown.initial_report().frame, 0);
  EXPECT_GT(shown.initial_report().steps, 0);
  const double fallen = 2 - sheet_of(plain.snapshot())[12].z();
  EXPECT_NEAR(2 - sheet_of(shown.snapshot())[12].z(), fallen, 1e-13);
  EXPECT_GT(fallen, 0.19);
  for (int k = 1; k <= 4; ++k) shown.advance(), plain.advance();
  EXPECT_EQ(shown.snapshot()->frame, 4);
  const std::vector<Vec3>&there = shown.snapshot()->states[1].positions, &here = plain.snapshot()->states[1].positions;
  for (std::size_t i = 0; i < there.size(); ++i) EXPECT_LT((there[i] - here[i]).norm(), 1e-14);
  EXPECT_TRUE(shown.run_preroll()) << "and then there is none left";
  EXPECT_EQ(shown.snapshot()->frame, 4);
}

// Each frame has one step. A stop requested during a step must not wait for the end of the step.
TEST(Stop, EndsAStepAndLeavesTheLastFrame) {
  scene::Scene scene = sheet_alone(0.6, 5, 2);
  scene.time.step = 1;
  production::SceneSimulation simulation(scene);
  simulation.advance();
  const auto before = simulation.state();
  const std::vector<Vec3> x(before.positions.begin(), before.positions.end());
  const auto advance_after = [&](long long waited) {
    stop_requested_at = monotonic_ns() - waited;
    try {
      simulation.advance();
    } catch (const Error& error) {
      stop_requested_at = 0;
      return error.code();
    }
    stop_requested_at = 0;
    return ExitCode::ok;
  };
  EXPECT_EQ(advance_after(2 * kStopGrace), ExitCode::interrupted);
  EXPECT_EQ(simulation.snapshot()->frame, 1);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(simulation.state().positions[i], x[i]);
  EXPECT_EQ(advance_after(0), ExitCode::ok) << "what is nearly done is finished";
  EXPECT_EQ(simulation.snapshot()->frame, 2);
}

}  // namespace
}  // namespace weft::simulation
