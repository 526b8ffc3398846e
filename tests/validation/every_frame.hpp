// Checks the guarantee on whole scenes: no frame has an intersection, with the scene's own step and with longer ones.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

#include "support/scene_runs.hpp"

namespace weft::simulation::testing {

/// A scene, the factor on its step, and the number of frames to run; negative: all.
struct SceneRun {
  const char* scene;
  int factor;
  int frames;
};

inline std::ostream& operator<<(std::ostream& out, const SceneRun& run) {
  return out << run.scene << ".toml with " << run.factor << " times its step";
}

inline std::string name_of_run(const ::testing::TestParamInfo<SceneRun>& run) {
  return run.param.scene + ("_x" + std::to_string(run.param.factor));
}

/// Overrides for scenes whose films have finer meshes than tests can afford.
inline std::vector<std::string> coarser(const std::string& scene) {
  if (scene == "falling_band") return {"cloth.band.particles=[17,161]"};
  if (scene == "ball_through_cloth") return {"cloth.sheet.particles=61"};
  return {};
}

inline scene::Scene scene_of(const SceneRun& run) {
  scene::Scene scene =
      support::scene_of(std::string(WEFT_SOURCE_DIR "/scenes/") + run.scene + ".toml", coarser(run.scene));
  scene.time.step *= run.factor;
  return scene;
}

/// Tests each frame with exact predicates, prints the number of intersections and expects none.
inline void expect_no_intersections(const SceneRun& run) {
#ifndef NDEBUG
  GTEST_SKIP() << "takes hours with sanitizers";
#endif
  const scene::Scene scene = scene_of(run);
  const int frames = run.frames < 0 ? scene.frame_count() : run.frames;
  std::size_t pairs = 0;
  int steps = 0, rejected = 0;
  double stretch = 1;
  support::run_scene(scene, {.end = frames}, [&](const support::MeasuredFrame& frame) {
    EXPECT_EQ(frame.pairs, 0u) << "frame " << frame.report.frame << ": " << frame.between;
    pairs += frame.pairs;
    steps += frame.report.steps;
    rejected += frame.report.rejected_steps;
    stretch = std::max(stretch, frame.max_stretch);
  });
  std::printf("%s, step %g s: %d of %d frames, %d steps, %d rejected, stretch up to %.3f: %zu intersecting pairs\n",
              run.scene, scene.time.step, frames, scene.frame_count(), steps, rejected, stretch, pairs);
}

}  // namespace weft::simulation::testing
