// Tests of ropes in runs: equal bits with any number of threads and after resuming, keyed lengths, attachments.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.hpp"
#include "film/environment/environment.hpp"
#include "film/production/plan.hpp"
#include "film/production/scene_simulation.hpp"
#include "physics/simulation/step_loop.hpp"
#include "physics/simulation/step_problem.hpp"
#include "simulation/saved_state.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

// A loop contracts around a cone and is tied to a line above; a sheet falls on both.
const char* const kTangle =
    "[time]\nduration = 0.6\nstep = 0.01\n"
    "[[cloth]]\nname = \"sheet\"\nsize = [0.4, 0.4]\nparticles = [13, 13]\nposition = [0, 0, 0.42]\n"
    "[[obstacle]]\nname = \"cone\"\nshape = \"cone\"\nradius = 0.15\nheight = 0.4\nsegments = 24\n"
    "[[rope]]\nname = \"loop\"\npoints = [[0.17, 0, 0.02], [0, 0.17, 0.02], [-0.17, 0, 0.02], [0, -0.17, 0.02]]\n"
    "smooth = true\nclosed = true\ndiameter = 0.008\n"
    "keys = [{ time = 0.1, length = 1.05 }, { time = 0.5, length = 0.7 }]\n"
    "[[rope]]\nname = \"line\"\nfrom = [-0.4, 0.01, 0.3]\nto = [0.4, 0.01, 0.3]\ndiameter = 0.006\n"
    "pin = [{ at = 0 }, { at = 1, release = 0.4 }]\nweight = [{ at = 0.8, mass = 0.05 }]\n"
    "[[attach]]\nname = \"knot\"\ncloth = \"line\"\nto = \"loop\"\nat = 0.75\n";

TEST(RopeRuns, HaveTheSameBitsOnAnyNumberOfThreads) {
  const scene::Scene scene = support::scene_of_text(kTangle);
  std::vector<std::vector<Vec3>> ends;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const auto last = support::run_scene(scene, {.counts_intersections = false}).back().cloths;
    std::vector<Vec3>& all = ends.emplace_back();
    for (const std::vector<Vec3>& cloth : last) all.insert(all.end(), cloth.begin(), cloth.end());
  }
  set_thread_count(0);
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(RopeRuns, GoOnFromSavedStatesAsIfNeverInterrupted) {
  EXPECT_EQ(testing::continue_runs(support::scene_of_text(kTangle), {14, {3, 7, 11}}).difference, "");
}

// The strains that colour a frame refer to the rest lengths at its time, also in the frame of the saved state.
TEST(RopeRuns, ShowTheStrainsOfTheirPresentLengthOnceTheyAreRestored) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.6\n[render]\nheat = \"strain\"\n"
      "[[rope]]\nname = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ndiameter = 0.006\npin = [{ at = 0 }]\n"
      "keys = [{ time = 0, length = 1 }, { time = 0.5, length = 0.7 }]\n");
  EXPECT_EQ(testing::continue_runs(scene, {12, {3, 7, 11}}).difference, "");
}

TEST(RopeRuns, AreDrawnInToTheLengthOfTheirKeys) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 1.2\n[[rope]]\nname = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ndiameter = 0.006\n"
      "pin = [{ at = 0 }]\nkeys = [{ time = 0.2, length = 1 }, { time = 1, length = 0.7 }]\n");
  const std::vector<Vec3> x = support::run_scene(scene, {.counts_intersections = false}).back().cloths.at(0);
  double length = 0;
  for (std::size_t i = 1; i < x.size(); ++i) length += (x[i] - x[i - 1]).norm();
  EXPECT_NEAR(length, 0.7, 1e-3);  // tolerance: more than the stretch of cotton by the rope's own weight
}

TEST(RopeRuns, HaveTheBendingStiffnessOfTheirLengthInTheMatrix) {
  const model::Model model =
      environment::Environment(
          support::scene_of_text("[[rope]]\nname = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 8\n"
                                 "keys = [{ time = 0, length = 1 }, { time = 1, length = 0.5 }]\n"))
          .model;
  ClothSystem cloth(model);
  const std::vector<Vec3>& x = model.cloths[0].start;
  const std::vector<Vec3> v(x.size(), Vec3::Zero());
  const auto blocks_at = [&](double t, StepProblem& problem) {
    problem.begin_step(t, x, {});
    std::vector<Vec3> force = v;
    problem.linearise({x, v, x, 100, 1}, 0, force);
    std::vector<Mat3> blocks;
    const solver::BlockMatrix& matrix = problem.memory().system.matrix;
    matrix.for_each_block(0, matrix.rows(), [&](Index, Index, const Mat3& block) { blocks.push_back(block); });
    return blocks;
  };
  StepProblem used(cloth), fresh(cloth);
  const std::vector<Mat3> before = blocks_at(0, used), after = blocks_at(1, used);
  EXPECT_NE(before, after);
  EXPECT_EQ(after, blocks_at(1, fresh));
}

// Putting on a layer replaces the step loop. If the first step of the new loop fails, its initial state is shown and
// saved, so this state must have the rope length of its time.
TEST(RopeRuns, HaveTheLengthOfTheirTimeOnceALayerIsPutOn) {
  const model::Model model =
      environment::Environment(
          support::scene_of_text("[[rope]]\nname = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 8\n"
                                 "keys = [{ time = 0, length = 1 }, { time = 1, length = 0.5 }]\n"))
          .model;
  const StepLoop inner(model, 1);
  StepLoop both(model, 1);
  both.copy_state_from(inner, std::vector<std::size_t>{0});
  EXPECT_NEAR(both.cloth().max_strain(both.progress().now.particles()), 1, 1e-9);
}

TEST(RopeRuns, BearWhatIsTiedToThem) {
  // A cord that carries 0.2 kg is tied to the middle of a taut line.
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 2\nstep = 0.02\n[[rope]]\nname = \"line\"\nfrom = [-0.5, 0, 0.1]\nto = [0.5, 0, 0.1]\n"
      "diameter = 0.006\ndamping = 0.1\npin = [{ at = 0 }, { at = 1 }]\n"
      "[[rope]]\nname = \"cord\"\nfrom = [0, 0, 0.08]\nto = [0, 0, -0.2]\ndiameter = 0.004\nmass = 0.01\ndamping = "
      "0.1\n"
      "drag = 20\nweight = [{ at = 1, mass = 0.2 }]\n"
      "[[attach]]\nname = \"knot\"\ncloth = \"cord\"\nto = \"line\"\nat = 0\n");
  production::SceneSimulation simulation(scene);
  FrameReport last;
  for (int frame = 1; frame < scene.frame_count(); ++frame) last = simulation.advance();
  EXPECT_NEAR(last.attachments.at(0).load / ((0.2 + 0.28 * 0.01) * 9.81), 1, 0.02);
}

TEST(RopeRuns, CountAsObjectsOfTheirOwnKind) {
  const production::SceneSimulation simulation(support::scene_of_text(kTangle));
  const std::vector<frame::ObjectInfo> objects = simulation.objects();
  const auto loop = std::ranges::find(objects, "loop", &frame::ObjectInfo::name);
  ASSERT_NE(loop, objects.end());
  EXPECT_EQ(loop->kind, frame::ObjectKind::rope);
  EXPECT_EQ(loop->vertices, loop->faces) << "a loop";
}

TEST(RopeRuns, ArePlannedWhereTheSceneHasSome) {
  const auto mentions_ropes = [](const scene::Scene& scene) {
    return std::ranges::any_of(production::plan(scene), [](const production::PlanItem& item) {
      return item.part.find("rope") != item.part.npos;
    });
  };
  EXPECT_TRUE(mentions_ropes(support::scene_of_text(kTangle)));
  EXPECT_FALSE(mentions_ropes(support::scene_of_text("[[cloth]]\nname = \"sheet\"\n")));
}

}  // namespace
}  // namespace weft::simulation
