// Steps that cannot be solved: what a failed frame leaves, and halving.
#include <gtest/gtest.h>

#include <string>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

using testing::sheet_alone;

// A steel sheet; in its fourth frame its edge moves away too fast.
scene::Scene sheet_with_fast_edge() {
  scene::Scene scene = sheet_alone(0.4, 9, 1);
  scene.solver.newton_iterations = 1;
  scene.solver.halvings = 0;
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1e7;
  scene::Pin pin;
  pin.low = {0, 1};
  pin.motion.interpolation = scene::Interpolation::linear;
  pin.motion.keys = {{0, {}}, {0.12, {}}, {0.16, {{5, 30, 20}, Quat::Identity()}}};
  scene.cloths[0].pins.push_back(pin);
  scene.physics.gravity = Vec3::Zero();
  return scene;
}

TEST(FailedStep, IsReportedWithItsFrameAndKeepsTheLastGoodOne) {
  production::SceneSimulation simulation(sheet_with_fast_edge());
  for (int k = 1; k <= 3; ++k) simulation.advance();
  const auto good = simulation.snapshot();
  for (int attempt = 0; attempt < 2; ++attempt) {
    support::expect_error(ExitCode::simulation_failed, "frame 4: the step at 0.12 s failed",
                          [&] { simulation.advance(); });
    EXPECT_EQ(simulation.snapshot(), good);
    EXPECT_EQ(simulation.snapshot()->frame, 3);
  }
}

TEST(FailedStep, InTheMiddleOfAFrameTakesBackTheFirstSteps) {
  scene::Scene scene = sheet_with_fast_edge();
  scene.physics.gravity = {0, 0, -9.81};
  scene.solver.newton_iterations = 3;
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1000;
  scene.cloths[0].pins[0].motion.keys[1].time = 0.14;  // after the first of the two steps of the frame
  scene.cloths[0].pins[0].motion.keys[2].pose.position = {500, 3000, 2000};
  production::SceneSimulation simulation(scene);
  for (int k = 1; k <= 3; ++k) simulation.advance();
  // The message contains the residual of the failed step. If the program kept the first step of the frame, a second
  // attempt would fail with another value.
  const auto failure = [&]() -> std::string {
    try {
      simulation.advance();
    } catch (const Error& error) {
      return error.what();
    }
    return "no failure";
  };
  const std::string first = failure();
  EXPECT_NE(first.find("frame 4: the step at 0.14 s failed"), std::string::npos) << first;
  EXPECT_EQ(failure(), first);
}

// The spring of the sheet to the post is tied in the first of the two steps of the frame; the second step fails.
TEST(FailedStep, InTheMiddleOfAFrameTakesBackWhatWasTied) {
  scene::Scene scene = sheet_with_fast_edge();
  scene.solver.newton_iterations = 3;
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1000;
  scene.cloths[0].pins[0].motion.keys[1].time = 0.14;
  scene.cloths[0].pins[0].motion.keys[2].pose.position = {500, 3000, 2000};
  scene.obstacles.push_back(testing::obstacle("post", scene::Sphere{0.1}, {3, 0, 0}));
  scene.obstacles[0].collide = false;
  scene::Attachment tie;
  tie.name = "tie";
  tie.cloth = scene.cloths[0].name;
  tie.to = "post";
  tie.begin = 0.13;
  scene.attachments.push_back(tie);
  production::SceneSimulation simulation(scene);
  for (int k = 1; k <= 3; ++k) simulation.advance();
  std::string before, after;
  simulation.save(before);
  support::expect_error(ExitCode::simulation_failed, "frame 4: the step at 0.14 s failed",
                        [&] { simulation.advance(); });
  simulation.save(after);
  EXPECT_TRUE(before == after);
}

TEST(FailedStep, IsHalvedUntilItCanBeSolved) {
  scene::Scene scene = sheet_with_fast_edge();
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1000;
  scene.cloths[0].pins[0].motion.keys[2].pose.position = {0, 0.5, 0.5};
  scene.solver.newton_iterations = 2;
  scene.solver.halvings = 10;
  production::SceneSimulation simulation(scene);
  for (int k = 1; k <= 3; ++k) simulation.advance();
  const FrameReport report = simulation.advance();
  EXPECT_GT(report.rejected_steps, 0);
  // Each rejection replaces one step by two.
  EXPECT_EQ(report.steps, 2 + report.rejected_steps);
  EXPECT_EQ(simulation.snapshot()->frame, 4);
}

}  // namespace
}  // namespace weft::simulation
