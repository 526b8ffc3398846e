// Tests of steps that cannot be solved: the state after a failed frame, and the halving of steps.
#include <gtest/gtest.h>

#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/numerics.hpp"
#include "core/stop.hpp"
#include "film/environment/environment.hpp"
#include "film/production/scene_simulation.hpp"
#include "physics/simulation/step_loop.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

using testing::sheet_alone;

// A sheet as stiff as steel. In the fourth frame, its pinned edge moves too fast for the solver.
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

// As above, but in the fourth frame, only the second of its two steps cannot be solved.
scene::Scene sheet_that_fails_in_mid_frame() {
  scene::Scene scene = sheet_with_fast_edge();
  scene.solver.newton_iterations = 3;
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1000;
  scene.cloths[0].pins[0].motion.keys[1].time = 0.14;
  scene.cloths[0].pins[0].motion.keys[2].pose.position = {500, 3000, 2000};
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
  scene::Scene scene = sheet_that_fails_in_mid_frame();
  scene.physics.gravity = {0, 0, -9.81};
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

// The spring between sheet and post begins in the first step of the frame.
TEST(FailedStep, InTheMiddleOfAFrameTakesBackWhatWasTied) {
  scene::Scene scene = sheet_that_fails_in_mid_frame();
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

// Each frame is computed, taken back to its start as after a failure, and computed again.
TEST(FailedStep, TakesBackPinchedClothAndPinsThatLag) {
  for (const char* text : {testing::kThinJaws, testing::kLaggingPin}) {
    const model::Model model = environment::Environment(support::scene_of_text(text)).model;
    StepLoop steps(model, 0);
    const auto advance = [&](int frame) {
      FrameReport report;
      report.frame = frame + 1;
      steps.advance(frame / model.time.fps, (frame + 1) / model.time.fps, report);
    };
    const auto take_obstructions = [&] { return steps.take_pinches().pairs + steps.take_lag_report().particles; };
    int found = 0;
    for (int frame = 0; found == 0; ++frame) {
      ASSERT_LT(frame, 10);
      StepLoop::Checkpoint start = steps.checkpoint();
      advance(frame);
      steps.return_to(std::move(start));
      EXPECT_EQ(take_obstructions(), 0) << "frame " << frame + 1;
      advance(frame);
      found = take_obstructions();
    }
  }
}

// The host drives the box under a sheet down, interrupts the step, and then drives the box up instead.
TEST(FailedStep, LeavesNoBodyWhereItWasDrivenThen) {
  scene::Scene scene = sheet_alone(0.4, 5, 0.11);
  scene.time.step = 0.04;
  scene.contact.obstacles = true;
  scene.obstacles.push_back(testing::obstacle("box", scene::BoxShape{{0.6, 0.6, 0.2}}));
  scene.obstacles[0].motion.keys = {{0, scene::Pose{}}, {9, scene::Pose{}}};  // with keys, the box may be driven
  const model::Model model = environment::Environment(scene).model;
  Simulation whole(model), interrupted(model);
  const auto drive = [](Simulation& simulation, double z) {
    motion::Pose end;
    end.position.z() = z;
    simulation.drive(0, end);
  };
  for (Simulation* simulation : {&whole, &interrupted}) simulation->allow_drive(0);
  drive(interrupted, -0.05);
  host_check = [] { throw std::runtime_error("interrupted"); };
  EXPECT_THROW(interrupted.advance(), std::runtime_error);
  host_check = nullptr;
  for (Simulation* simulation : {&whole, &interrupted}) {
    drive(*simulation, 0.05);
    simulation->advance();
  }
  const std::span<const Vec3> x = interrupted.state().positions, expected = whole.state().positions;
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_GT(x[i].z(), 0.15);
    EXPECT_LT((x[i] - expected[i]).norm(), 1e-12);
  }
}

// An early check finds that the box obstructs the pin; then the solve goes on, and takes too many iterations.
TEST(FailedStep, ReleasesNoPinIfTheSolverIsTheReason) {
  model::Model model = environment::Environment(support::scene_of_text(testing::kLaggingPin)).model;
  model.cloths[0].pins[0].motion.keys[1].time = 0.01;
  model.solver.newton_iterations = 5;
  model.solver.newton_tolerance = 1e-12;
  model.solver.halvings = 0;
  StepLoop steps(model, 0);
  FrameReport report;
  EXPECT_THROW(steps.advance(0, 0.04, report), Error);
  // The iterations of one attempt: until the check, perhaps twice (StepLoop::solve_contacts), and after it.
  EXPECT_LE(report.newton_iterations, 2 * numerics.newton.check_after + 5);
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
