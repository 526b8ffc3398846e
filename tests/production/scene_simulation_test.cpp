// Snapshots of a simulation of a scene.
#include "film/production/scene_simulation.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/scene_runs.hpp"

namespace weft::production {
namespace {

const char* const kFalling = "[[cloth]]\nname = 'sheet'\nparticles = 3\n[render]\nheat = 'speed'\n";

TEST(SceneSimulation, MakesOneSnapshotForEachState) {
  SceneSimulation simulation(support::scene_of_text(kFalling));
  const frame::SnapshotPtr start = simulation.snapshot();
  EXPECT_EQ(simulation.snapshot(), start);
  std::string state;
  simulation.save(state);
  simulation.advance();
  const frame::SnapshotPtr next = simulation.snapshot();
  EXPECT_NE(next, start);
  EXPECT_EQ(next->frame, 1);
  EXPECT_EQ(simulation.snapshot(), next);
  EXPECT_LT(next->states[0].positions[0].z(), start->states[0].positions[0].z());
  EXPECT_GT(next->states[0].heat[0], 0.3F) << "the speed of a fall of 0.04 s";
  SceneSimulation resumed(support::scene_of_text(kFalling));
  const frame::SnapshotPtr before = resumed.snapshot();
  resumed.restore(state);
  EXPECT_NE(resumed.snapshot(), before) << "of the state before";
}

TEST(SceneSimulation, KeepsASnapshotAsItWas) {
  SceneSimulation simulation(support::scene_of_text(kFalling));
  const frame::SnapshotPtr start = simulation.snapshot();
  const Vec3 corner = start->states[0].positions[0];
  for (int k = 0; k < 3; ++k) simulation.advance();
  EXPECT_EQ(start->states[0].positions[0], corner);
  EXPECT_EQ(simulation.snapshot()->frame, 3);
}

}  // namespace
}  // namespace weft::production
