// Tests of `time.tolerance`, with which the program chooses step lengths, and of frames at rest, which are one step.
#include "physics/integrator/step_control.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <vector>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

scene::Scene falling_sheet(scene::Integrator integrator, double tolerance) {
  scene::Scene scene = testing::sheet_alone(1, 5, 2);
  scene.time.integrator = integrator;
  scene.time.tolerance = tolerance;
  testing::solve_tightly(scene);
  scene.solver.halvings = 8;
  return scene;
}

// Distance by which the sheet, after this number of frames, is lower than by the law of free fall [m].
double ahead_of_free_fall(const production::SceneSimulation& simulation, int frames) {
  const double t = frames / 25.0;
  return 2 - 0.5 * 9.81 * t * t - testing::sheet_of(simulation.snapshot())[7].z();
}

TEST(StepTolerance, StepsEndOnFramesWhateverTheirLength) {
  // The midpoint rule is exact in free fall, so each frame shows whether its steps add up to the duration of the frame.
  production::SceneSimulation simulation(falling_sheet(scene::Integrator::implicit_midpoint, 1e-5));
  int steps = 0;
  for (int k = 1; k <= 10; ++k) {
    const FrameReport report = simulation.advance();
    steps += report.steps;
    // The estimated error is zero, so steps grow to whole frames.
    if (k > 5) {
      EXPECT_EQ(report.steps, 1);
    }
    // Tolerance [m]: the residual of Newton's method. One step too many or too few would change the height by
    // centimetres.
    EXPECT_NEAR(ahead_of_free_fall(simulation, k), 0, 1e-8);
  }
  EXPECT_GT(steps, 12);
}

TEST(StepTolerance, EstimateIsTheErrorInFreeFall) {
  // In each Euler step of length h, the sheet falls too far by ½ g h², and this error stays.
  production::SceneSimulation simulation(falling_sheet(scene::Integrator::implicit_euler, 1e-5));
  double estimate = 0;
  for (int k = 1; k <= 10; ++k) {
    const FrameReport report = simulation.advance();
    EXPECT_LE(report.error_estimate, 1e-5 * report.steps);
    EXPECT_GT(report.error_estimate, 0.4e-5 * report.steps);
    estimate += report.error_estimate;
    EXPECT_NEAR(ahead_of_free_fall(simulation, k), estimate, 1e-9);
  }
}

TEST(StepTolerance, EstimateIsThereWithFixedStepsToo) {
  scene::Scene scene = falling_sheet(scene::Integrator::implicit_euler, 1);
  scene.time.tolerance.reset();
  scene.time.step = 0.01;
  production::SceneSimulation simulation(scene);
  EXPECT_EQ(simulation.initial_report().error_estimate, 0);
  EXPECT_NEAR(simulation.advance().error_estimate, 4 * 0.5 * 1e-4 * 9.81, 1e-9);
}

// A sheet falls flat on the floor.
scene::Scene landing_sheet(scene::Integrator integrator, double tolerance) {
  scene::Scene scene = falling_sheet(integrator, tolerance);
  scene.contact.self = scene.contact.obstacles = true;
  scene.solver = {};
  scene.cloths[0].pose.position.z() = 0.3;
  scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
  return scene;
}

TEST(StepTolerance, ImpactTakesShortStepsButNotWithoutEnd) {
  for (scene::Integrator integrator : {scene::Integrator::implicit_euler, scene::Integrator::bdf2}) {
    production::SceneSimulation simulation(landing_sheet(integrator, 1e-4));
    int max_steps = 0, rejected = 0;
    for (int k = 1; k <= 25; ++k) {
      const FrameReport report = simulation.advance();
      max_steps = std::max(max_steps, report.steps);
      rejected += report.rejected_steps;
      EXPECT_GT(report.min_distance, 0);
    }
    EXPECT_GT(rejected, 0);
    // The sheet stops from 2.4 m/s. To meet the tolerance, one step must be as short as about 1e-4 s.
    EXPECT_LT(max_steps, 200);
    EXPECT_GT(testing::lowest(testing::sheet_of(simulation.snapshot())), 0);
  }
}

TEST(StepTolerance, GivesTheSameBitsAgain) {
  for (scene::Integrator integrator : {scene::Integrator::implicit_euler, scene::Integrator::bdf2}) {
    production::SceneSimulation first(landing_sheet(integrator, 1e-4)), second(landing_sheet(integrator, 1e-4));
    for (int k = 1; k <= 12; ++k) {
      first.advance();
      second.advance();
      ASSERT_EQ(testing::sheet_of(first.snapshot()), testing::sheet_of(second.snapshot())) << "frame " << k;
    }
  }
}

TEST(StepTolerance, ErrorThatAStepCannotMeetIsTakenAndCounted) {
  // No halvings: each step is tried once.
  scene::Scene scene = landing_sheet(scene::Integrator::bdf2, 1e-4);
  scene.solver.halvings = 0;
  production::SceneSimulation simulation(scene);
  int inexact = 0;
  for (int k = 1; k <= 10; ++k) {
    const FrameReport report = simulation.advance();
    EXPECT_EQ(report.rejected_steps, 0);
    inexact += report.inexact_steps;
  }
  EXPECT_GT(inexact, 0);
}

/// A pinned edge that moves away at 9e4 m/s.
scene::Pin fast_edge() {
  scene::Pin edge;
  edge.low = {0, 1};
  edge.motion.interpolation = scene::Interpolation::linear;
  edge.motion.keys = {{0, {}}, {0.12, {}}, {0.16, {{0, 3000, 2000}, Quat::Identity()}}};
  return edge;
}

TEST(StepTolerance, StepThatCannotBeSolvedEndsTheRunWithTheStateBefore) {
  scene::Scene scene = falling_sheet(scene::Integrator::bdf2, 1e-4);
  scene.solver.newton_iterations = 1;
  scene.solver.linear_iterations = 1;
  const scene::Pin edge = fast_edge();
  scene.cloths[0].pins.push_back(edge);
  production::SceneSimulation simulation(scene);
  std::string said[2];
  for (std::string& text : said) {
    try {
      for (int k = 0; k < 25; ++k) simulation.advance();
    } catch (const std::exception& error) {
      text = error.what();
    }
    EXPECT_NE(text.find("try a smaller time.tolerance"), std::string::npos) << text;
  }
  // A second attempt, from the last good state, fails in the same way.
  EXPECT_EQ(said[0], said[1]);
}

TEST(StepTolerance, RunThatIsStuckIsRefusedInsteadOfShorteningStepsForEver) {
  // One iteration cannot solve a step of a sheet that is 10⁴ times too long.
  scene::Scene scene = falling_sheet(scene::Integrator::bdf2, 1e-3);
  scene.solver.newton_iterations = 1;
  scene.solver.linear_iterations = 1;
  scene.solver.newton_tolerance = 1e-6;
  scene.solver.halvings = 40;
  scene.cloths[0].start_scale = {1e4, 1e4};
  scene.cloths[0].start_noise = 1;
  production::SceneSimulation simulation(scene);
  std::string text;
  try {
    for (int k = 0; k < 25; ++k) simulation.advance();
  } catch (const std::exception& error) {
    text = error.what();
  }
  double h = 0;
  const auto at = text.find("shortened to ");
  ASSERT_NE(at, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + at, "shortened to %lf", &h), 1);
  EXPECT_LT(h, numerics.steps.min_step);
  // Each try is at least a fifth as long as the previous one.
  EXPECT_GE(h, 0.2 * numerics.steps.min_step);
}

// A sheet on a block hangs down over its edges; two steps per frame.
scene::Scene sheet_on_block() {
  scene::Scene scene = testing::sheet_alone(0.3, 9, 0.103);
  scene.time.duration = 4;
  scene.contact.obstacles = true;
  scene.obstacles.push_back(testing::obstacle("block", scene::BoxShape{{0.2, 0.2, 0.1}}, {0, 0, 0.05}));
  return scene;
}

// A sheet hangs flat from its upper edge; two steps per frame.
scene::Scene sheet_that_hangs() {
  scene::Scene scene = testing::sheet_alone(0.3, 5, 1);
  scene.time.duration = 4;
  scene.cloths[0].pose.rotation = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  scene::Pin pin;
  pin.low = {0, 1};
  scene.cloths[0].pins = {pin};
  return scene;
}

// Number of steps of each of the next `frames` frames.
std::vector<int> steps_of(production::SceneSimulation& simulation, int frames) {
  std::vector<int> steps;
  for (int k = 0; k < frames; ++k) steps.push_back(simulation.advance().steps);
  return steps;
}

double mean_height(const production::SceneSimulation& simulation) {
  double sum = 0;
  for (const Vec3& x : testing::sheet_of(simulation.snapshot())) sum += x.z();
  return sum / static_cast<double>(simulation.particles());
}

TEST(Rest, TakesOneStepAFrameAndMovesNothing) {
  scene::Scene scene = sheet_on_block();
  production::SceneSimulation resting(scene);
  // A body that moves inside the block prevents rest: every step is taken.
  scene.obstacles.push_back(testing::obstacle("inside", scene::Sphere{0.005}));
  scene.obstacles.back().motion.keys = {{0, {{0, 0, 0.09}, Quat::Identity()}},
                                        {9, {{0.01, 0, 0.09}, Quat::Identity()}}};
  production::SceneSimulation stepping(scene);
  const std::vector<int> steps = steps_of(resting, 50);
  EXPECT_EQ(steps.front(), 2);
  EXPECT_EQ(steps_of(stepping, 50), std::vector<int>(50, 2));
  for (int k = 40; k < 50; ++k) EXPECT_EQ(steps[static_cast<std::size_t>(k)], 1) << "frame " << k + 1;
  // An acceleration of 0.01 m/s² causes 8 µm in a frame of 40 ms. The bound adds this deviation for each resting frame.
  const double farthest = 8e-6 * static_cast<double>(std::ranges::count(steps, 1));
  const auto &x = testing::sheet_of(resting.snapshot()), &expected = testing::sheet_of(stepping.snapshot());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((x[i] - expected[i]).norm(), farthest) << "particle " << i;
}

// Without gravity and air, no force acts on a drifting sheet, so only its speed decides whether it rests.
TEST(Rest, IsSlow) {
  for (const double speed : {0.01, 0.1}) {
    scene::Scene scene = testing::sheet_alone(0.3, 5, 1);
    scene.physics.gravity = Vec3::Zero();
    scene.cloths[0].velocity = {speed, 0, 0};
    production::SceneSimulation drifting(scene);
    EXPECT_EQ(steps_of(drifting, 3).back(), speed < 0.02 ? 1 : 2) << speed << " m/s";
  }
}

TEST(Rest, EndsWithTheFrameInWhichSomethingMovesOrIsLetGo) {
  scene::Scene scene = sheet_on_block();
  scene.obstacles[0].motion.keys = {{0, {{0, 0, 0.05}, Quat::Identity()}},
                                    {2.03, {{0, 0, 0.05}, Quat::Identity()}},
                                    {2.6, {{0, 0, 0.25}, Quat::Identity()}}};
  scene.obstacles[0].motion.interpolation = scene::Interpolation::linear;
  production::SceneSimulation lifted(scene);
  const std::vector<int> of_lifted = steps_of(lifted, 60);
  EXPECT_EQ(of_lifted[49], 1);
  for (int k = 50; k < 60; ++k) EXPECT_EQ(of_lifted[static_cast<std::size_t>(k)], 2) << "frame " << k + 1;

  scene = sheet_that_hangs();
  scene.cloths[0].pins[0].release = 1.99;
  production::SceneSimulation released(scene);
  EXPECT_EQ(steps_of(released, 49).back(), 1);
  const double hung_at = mean_height(released);
  EXPECT_EQ(steps_of(released, 2), std::vector<int>(2, 2));
  // In the three steps of 20 ms that end after the release, implicit Euler falls by 6 g h². Before, the sheet creeps by
  // 0.4 mm/s. One step more or less would change the fall by 12 mm.
  EXPECT_NEAR(hung_at - mean_height(released), 6 * 9.81 * 0.02 * 0.02, 2e-4);
}

TEST(Rest, DetectsABodyThatMovesAndReturnsWithinAFrame) {
  const auto there_and_back = [](const Vec3& place) {
    return std::vector<scene::PoseKey>{{0, {place, Quat::Identity()}},
                                       {2.005, {place, Quat::Identity()}},
                                       {2.02, {place + Vec3(0.01, 0, 0), Quat::Identity()}},
                                       {2.035, {place, Quat::Identity()}}};
  };
  scene::Scene scene = sheet_on_block();
  scene.obstacles.push_back(testing::obstacle("inside", scene::Sphere{0.005}));
  scene.obstacles.back().motion = {scene::Interpolation::linear, there_and_back({0, 0, 0.09})};
  production::SceneSimulation beside(scene);
  EXPECT_EQ(steps_of(beside, 50).back(), 1);
  EXPECT_EQ(beside.advance().steps, 2);

  scene = sheet_that_hangs();
  scene::PinTrack& pinned = scene.cloths[0].pins[0].motion;
  pinned.interpolation = scene::Interpolation::linear;
  for (const scene::PoseKey& key : there_and_back(Vec3::Zero())) pinned.keys.push_back({key.time, key.pose});
  production::SceneSimulation pulled(scene);
  EXPECT_EQ(steps_of(pulled, 50).back(), 1);
  EXPECT_EQ(pulled.advance().steps, 2);

  scene = sheet_that_hangs();
  scene.physics.interpolation = scene::Interpolation::linear;
  for (const scene::PoseKey& key : there_and_back(Vec3::Zero()))
    scene.physics.keys.push_back({key.time, scene.physics.gravity + 100 * key.pose.position, scene.physics.wind});
  production::SceneSimulation shaken(scene);
  EXPECT_EQ(steps_of(shaken, 50).back(), 1);
  EXPECT_EQ(shaken.advance().steps, 2);
}

// A strip of felt in cells of 3 by 27 mm, thrown while it hangs. Its bending friction leaves velocities of some
// micrometres per second whose sign alternates. In the shortest steps, these velocities are as large, so the visibility
// threshold must accept them.
TEST(StepThatStalls, AcceptsInvisibleResiduals) {
  production::SceneSimulation simulation(support::scene_of_text(R"(
time = { step = 0.002, integrator = 'bdf2' }
[[cloth]]
name = 'c'
shape = 'crossed_triangles'
size = [0.05442, 0.05442]
particles = [17, 3]
position = [-0.05356, -0.09301, 0.7707]
rotation = [90, 0, 175.8]
material = { fabric = 'felt', friction = 0.1 }
velocity = [-3.715, -2.509, 0.8311]
[[cloth.pin]]
low = [0, 1]
high = [1, 1]
keys = [{ time = 0, offset = [0, 0, 0] }, { time = 0.296, offset = [-0.03764, 0.02002, 0.1006] }, { time = 0.75, offset = [-0.1474, -0.004883, 0.1499] }]
[[obstacle]]
name = 'floor'
shape = 'plane'
)"));
  const FrameReport& report = simulation.advance();
  EXPECT_EQ(report.rejected_steps, 0);
  EXPECT_EQ(report.steps, 20);
}

TEST(Rest, IsNotForMethodsThatKeepSmallMotionNorForGusts) {
  for (const scene::Integrator integrator : {scene::Integrator::implicit_midpoint, scene::Integrator::bdf2}) {
    scene::Scene scene = sheet_on_block();
    scene.obstacles.clear();
    scene.physics.gravity.setZero();
    scene.time.integrator = integrator;
    production::SceneSimulation simulation(scene);
    EXPECT_EQ(steps_of(simulation, 3), std::vector<int>(3, 2));
    scene.time.integrator = scene::Integrator::implicit_euler;
    production::SceneSimulation euler(scene);
    EXPECT_EQ(steps_of(euler, 3), (std::vector<int>{2, 1, 1}));  // the first frame is not yet known to rest
    scene.physics.air_density = 1.2;
    scene.physics.gusts.speed = 0.001;
    production::SceneSimulation blown(scene);
    EXPECT_EQ(steps_of(blown, 3), std::vector<int>(3, 2));
  }
}

}  // namespace
}  // namespace weft::simulation
