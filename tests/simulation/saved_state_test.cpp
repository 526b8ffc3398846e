// Tests that a run that continues from a saved state equals the uninterrupted run, bit for bit.
#include "simulation/saved_state.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <ostream>
#include <stdexcept>

#include "core/parallel.hpp"
#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

using testing::ContinuationResult;
using testing::continue_runs;
using testing::kThinJaws;

// A sheet falls on a ball, folds down its sides, and touches itself and the floor.
constexpr const char* kDrape = R"(
[time]
duration = 1
[[cloth]]
name = "sheet"
size = [0.5, 0.5]
particles = [12, 12]
position = [0.02, 0, 0.27]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.15
segments = 16
position = [0, 0, 0.1]
[[obstacle]]
name = "floor"
shape = "plane"
position = [0, 0, -0.05]
)";

// Two sheets rest on a tray that moves slowly, so that one search for near pairs serves many frames.
constexpr const char* kAtRest = R"(
[time]
duration = 1
[[cloth]]
name = "lower"
size = [0.3, 0.3]
particles = [11, 11]
position = [0, 0, 0.0012]
velocity = [0, 0, -0.02]
[[cloth]]
name = "upper"
size = [0.26, 0.26]
particles = [10, 10]
position = [0.01, 0.02, 0.0032]
rotation = [0, 0, 20]
[[obstacle]]
name = "tray"
shape = "box"
size = [0.5, 0.5, 0.02]
interpolation = "linear"
keys = [{ time = 0, position = [0, 0, -0.01] }, { time = 2, position = [0.002, 0, -0.01] }]
[[obstacle]]
name = "wall"
shape = "box"
size = [0.02, 0.5, 0.2]
position = [0.3, 0, 0.1]
)";

// Two sheets are buttoned to each other and pegged to a rail; one peg breaks. There are a fan and keys for gravity and
// wind, and pressure inflates the larger sheet.
constexpr const char* kWashing = R"(
[time]
duration = 1
[physics]
keys = [{ time = 0.2, wind = [0, 0, 0] }, { time = 0.5, wind = [0, 3, 0], gravity = [0, 0, -6] }]
[[fan]]
name = "fan"
position = [0.5, -0.6, 0.8]
direction = [-0.4, 1, 0]
keys = [{ time = 0.1, speed = 0 }, { time = 0.6, speed = 7 }]
[[cloth]]
name = "towel"
size = [0.4, 0.4]
particles = [11, 11]
position = [0, 0, 0.75]
rotation = [90, 0, 0]
spin = [0, 0, 40]
pressure.keys = [{ time = 0, gauge = 0 }, { time = 0.5, gauge = 6 }]
[[cloth]]
name = "patch"
size = [0.2, 0.2]
particles = [6, 6]
position = [0, -0.03, 0.7]
rotation = [90, 0, 0]
[[obstacle]]
name = "rail"
shape = "box"
size = [0.6, 0.02, 0.02]
interpolation = "linear"
keys = [{ time = 0, position = [0, 0, 0.98] }, { time = 1, position = [0.1, 0, 1.0] }]
[[attach]]
name = "left"
cloth = "towel"
to = "rail"
low = [0, 1]
high = [0.1, 1]
[[attach]]
name = "right"
cloth = "towel"
to = "rail"
low = [0.9, 1]
high = [1, 1]
breaking_load = 0.3
[[attach]]
name = "button"
cloth = "patch"
to = "towel"
low = [0.4, 0.9]
high = [0.6, 1]
begin = 0.1
)";

// A flag of triangles in the wind, coloured by strain, with a pin that is released.
constexpr const char* kFlag = R"(
[time]
duration = 1
[physics]
wind = [3, 0.5, 0]
[render]
heat = "strain"
[[cloth]]
name = "flag"
shape = "crossed_triangles"
size = [0.4, 0.3]
particles = [8, 6]
position = [0, 0, 1]
rotation = [90, 0, 0]
material = { bend = 1e-4, bend_viscosity = 1e-5, bend_friction = 1e-4 }
pin = [{ low = [0, 0], high = [0, 1] }, { low = [0.9, 0.9], high = [1, 1], release = 0.2 }]
)";

// A sheet lies on a wide plate that turns until 0.2 s. While it turns, steps have a quarter of their length.
// Afterwards, each step is at most twice as long as the one before, because during contact, BDF2 replaces the midpoint
// rule.
constexpr const char* kTurntable = R"(
[time]
duration = 1
[[cloth]]
name = "sheet"
size = [0.2, 0.2]
particles = [7, 7]
position = [0, 0, 0.0012]
[[obstacle]]
name = "plate"
shape = "box"
size = [6, 6, 0.02]
interpolation = "linear"
keys = [
  { time = 0, position = [0, 0, -0.01] }, { time = 0.2, position = [0, 0, -0.01], rotation = [0, 0, 100] },
]
)";

struct Kind {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
  testing::Interruptions interruptions;
};

std::ostream& operator<<(std::ostream& out, const Kind& kind) {
  return out << kind.name;
}

class SavedState : public ::testing::TestWithParam<Kind> {};

TEST_P(SavedState, ContinuesWithTheSameBits) {
  const scene::Scene scene = support::scene_of_text(GetParam().scene, GetParam().overrides);
  EXPECT_EQ(continue_runs(scene, GetParam().interruptions).difference, "");
}

const std::vector<int> kSome{0, 6, 9, 12};

INSTANTIATE_TEST_SUITE_P(
    Of, SavedState,
    ::testing::Values(
        Kind{"euler", kDrape, {"time.integrator=implicit_euler"}, {14, kSome}},
        Kind{"midpoint", kDrape, {"time.integrator=implicit_midpoint", "time.step=0.005"}, {14, kSome}},
        Kind{"bdf2", kDrape, {"time.integrator=bdf2"}, {14, kSome}},
        Kind{"one_thread_then_three", kDrape, {}, {14, kSome, 3}},
        Kind{"controlled_euler", kDrape, {"time.integrator=implicit_euler", "time.tolerance=3e-4"}, {11, {0, 7, 9}}},
        Kind{"controlled_midpoint", kDrape, {"time.integrator=implicit_midpoint", "time.tolerance=1e-3"}, {10, {3, 8}}},
        Kind{"controlled_bdf2", kDrape, {"time.integrator=bdf2", "time.tolerance=3e-4"}, {11, {0, 7, 9}}},
        Kind{"velocity_constraints", kDrape, {"contact.response=velocity_constraints"}, {14, kSome}},
        Kind{"separation_lists", kDrape, {"contact.search.separation_lists=true"}, {14, kSome}},
        Kind{"velocity_cones", kDrape, {"contact.search.velocity_cones=true"}, {14, kSome}},
        Kind{"normal_cones", kDrape, {"contact.search.normal_cones=true"}, {14, kSome}},
        Kind{"no_reuse", kDrape, {"contact.search.reuse=false"}, {14, kSome}}, Kind{"settled", kDrape, {}, {28, {25}}},
        Kind{"settled_velocity_cones", kDrape, {"contact.search.velocity_cones=true"}, {28, {25}}},
        Kind{"at_rest", kAtRest, {}, {24, {0, 5, 10, 15, 20, 22}}},
        Kind{"at_rest_velocity_constraints", kAtRest, {"contact.response=velocity_constraints"}, {20, {5, 10, 18}}},
        Kind{"at_rest_separation_lists", kAtRest, {"contact.search.separation_lists=true"}, {20, {5, 10, 18}}},
        Kind{"at_rest_velocity_cones", kAtRest, {"contact.search.velocity_cones=true"}, {20, {5, 10, 18}}},
        Kind{"gusts_one_thread_then_three", kFlag, {"physics.gusts.speed=1.5"}, {14, kSome, 3}},
        Kind{"flag", kFlag, {}, {14, {0, 3, 5, 9}}},
        Kind{"washing_one_thread_then_three", kWashing, {}, {18, {0, 2, 3, 9, 14}, 3}},
        Kind{"midpoint_after_short_steps", kTurntable, {"time.integrator=implicit_midpoint"}, {8, {4, 5, 6}}},
        Kind{"preroll", kDrape, {"time.preroll=0.4"}, {14, {4, 9, 10, 12}}}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(SavedStates, OfPinchedClothKeepOriginsAndWarnings) {
  const ContinuationResult pinched = continue_runs(support::scene_of_text(kThinJaws), {14, {4, 6, 8, 11}});
  EXPECT_EQ(pinched.difference, "");
  EXPECT_GT(pinched.pinched_pairs, 0);
}

TEST(SavedStates, OfAPinThatLagsKnowThatItDoes) {
  const ContinuationResult lagging = continue_runs(support::scene_of_text(testing::kLaggingPin), {16, {3, 5, 9, 14}});
  EXPECT_EQ(lagging.difference, "");
}

TEST(SavedStates, OfAPrerollKeepItsWarnings) {
  scene::Scene scene = support::scene_of_text(kThinJaws, {"time.preroll=0.6"});
  for (scene::Obstacle& jaw : scene.obstacles)
    for (scene::PoseKey& key : jaw.motion.keys) key.time -= 0.6;
  const ContinuationResult pinched = continue_runs(scene, {16, {4, 8, 14, 15}});
  EXPECT_EQ(pinched.difference, "");
  production::SceneSimulation simulation(scene);
  simulation.run_preroll();
  EXPECT_FALSE(simulation.initial_report().warnings.empty());
}

TEST(SavedStates, AfterRejectedAndInexactStepsGoOnTheSameWay) {
  scene::Scene scene = support::scene_of_text(
      kDrape, {"time.integrator=bdf2", "solver.newton_iterations=9", "solver.newton_tolerance=0.01"});
  const ContinuationResult rejected = continue_runs(scene, {12, {5, 6, 8, 9}});
  EXPECT_EQ(rejected.difference, "");
  EXPECT_GT(rejected.rejected_steps, 0);

  scene = support::scene_of_text(kDrape, {"time.integrator=bdf2", "time.tolerance=1e-4", "solver.halvings=0"});
  const ContinuationResult inexact = continue_runs(scene, {8, {2, 5, 6}});
  EXPECT_EQ(inexact.difference, "");
  EXPECT_GT(inexact.inexact_steps, 0);
}

TEST(SavedStates, KeepTheBoundOfEnergy) {
  // A sheet hangs from two corners; the steps are far too long for the midpoint rule.
  scene::Scene scene = testing::sheet_alone(0.5, 11, 1);
  scene.time = {.duration = 10, .fps = 10, .step = 0.02, .integrator = scene::Integrator::implicit_midpoint};
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 100;
  testing::pin_corners(scene.cloths[0], 1);
  const auto refusal = [](production::SceneSimulation& simulation, std::vector<std::string>* states) {
    for (int k = 0; k < 100; ++k) try {
        simulation.advance();
        if (states != nullptr) simulation.save(states->emplace_back());
      } catch (const Error& error) {
        return std::string(error.what());
      }
    return std::string("none");
  };
  std::vector<std::string> states;
  production::SceneSimulation first(scene);
  const std::string words = refusal(first, &states);
  EXPECT_NE(words.find("more than at the start"), std::string::npos) << words;
  ASSERT_GT(states.size(), 2u);
  // The message contains the energy in play, which depends on minima and maxima over all earlier frames.
  for (const std::string& state : {states.front(), states.back()}) {
    production::SceneSimulation resumed(scene);
    resumed.restore(state);
    EXPECT_EQ(refusal(resumed, nullptr), words);
  }
}

class SavedGarment : public support::TestFolder {};

TEST_F(SavedGarment, IsSewnOnInThePrerollAndAfter) {
  support::write_bytes(folder_ / "tube.toml", testing::kTube + R"([[elastic]]
edge = "front.top"
ratio = 0.85
)");
  const scene::Scene scene = support::scene_of_text(
      "[[cloth]]\nname = 'tube'\nshape = 'pattern'\nfile = '" + (folder_ / "tube.toml").string() +
      "'\nedge_length = 0.05\nsewing = 0.55\nposition = [0, 0, 0.1]\n"
      "[time]\nduration = 0.6\npreroll = 0.4\n[render]\nheat = 'strain'\n"
      "[[obstacle]]\nname = 'post'\nshape = 'cylinder'\nradius = 0.1\nheight = 1.2\n"
      "position = [0, 0, 0.4]\nsegments = 24\n");
  EXPECT_EQ(continue_runs(scene, {17, {3, 9, 11, 14}}).difference, "");
}

// The garment closes at 0.3 s. States before and after must contain the amount of enclosed air.
TEST_F(SavedGarment, KeepsTheAirThatItWasClosedWith) {
  support::write_bytes(folder_ / "tube.toml", testing::kTube + R"([[seam]]
a = "front.hem"
b = "back.hem"
[[seam]]
a = "front.top"
b = "back.top"
)");
  const scene::Scene scene = support::scene_of_text(
      "[physics]\ngravity = [0, 0, -2]\n[[cloth]]\nname = 'bag'\nshape = 'pattern'\nfile = '" +
      (folder_ / "tube.toml").string() +
      "'\nedge_length = 0.06\nsewing = 0.3\npressure = { control = 'fill', keys = [{ time = 0.2, fill = 1 }, { time = "
      "0.5, fill = 1.3 }] }\n[time]\nduration = 0.6\n");
  EXPECT_EQ(continue_runs(scene, {13, {3, 7, 8, 11}}).difference, "");
}

// The zip opens at 0.12 s and closes from 0.24 s on: states are saved before, between, during closing, and after.
TEST_F(SavedGarment, KnowsWhetherItsZipIsOpen) {
  std::string text = testing::kTube + "open = 0.12\nclosed = 0.24\n";
  text.insert(text.find("path", text.find("side")), "fabric = { stretch = 2, bend = 3, density = 1.5 }\n");
  support::write_bytes(folder_ / "tube.toml", text);
  const scene::Scene scene = support::scene_of_text(
      "[[cloth]]\nname = 'tube'\nshape = 'pattern'\nfile = '" + (folder_ / "tube.toml").string() +
      "'\nedge_length = 0.05\nsewing = 0.2\n[time]\nduration = 0.6\npreroll = 0.2\n");
  EXPECT_EQ(continue_runs(scene, {15, {2, 5, 8, 13}}).difference, "");
}

// The state has the place to which an earlier wind carried the gusts.
TEST(SavedStates, OfAChangedWindHaveItsGusts) {
  const model::Model model =
      environment::Environment(
          support::scene_of_text("[physics.gusts]\nspeed = 3\n[[cloth]]\nname = 'flag'\nsize = [0.2, 0.2]\nparticles = "
                                 "[5, 5]\nrotation = [90, 0, 0]\npin = [{ low = [0, 0], high = [0, 1] }]\n"))
          .model;
  const Vec3 wind(6, 2, 0);
  Simulation whole(model), resumed(model);
  whole.advance();
  whole.advance();
  whole.set_weather(model.physics.gravity, wind);
  whole.advance();
  std::string bytes;
  whole.save(bytes);
  resumed.set_weather(model.physics.gravity, wind);
  resumed.restore(bytes);
  whole.advance();
  resumed.advance();
  EXPECT_TRUE(resumed.particles_of_all() == whole.particles_of_all());
}

TEST(SavedStates, OfASceneWithACharacterFindItWhereItWalks) {
  const scene::Scene scene = support::scene_of_text(R"(
[time]
duration = 0.5
preroll = 0.2
[[character]]
name = "model"
source = "mannequin"
edge_length = 0.05
dressing = 0.1
blend = 0.1
walk = 1
[[cloth]]
name = "sheet"
size = [0.3, 0.3]
particles = [9, 9]
position = [0, 0, 1.83]
)");
  const ContinuationResult walked = continue_runs(scene, {9, {3, 7}});
  EXPECT_EQ(walked.difference, "");
  EXPECT_GT(walked.most_proximities, 0);
}

// For any bytes, restoring throws std::runtime_error or gives a simulation that works.
void try_bytes(const scene::Scene& scene, const std::string& bytes) {
  production::SceneSimulation simulation(scene);
  try {
    simulation.restore(bytes);
    EXPECT_EQ(simulation.snapshot()->states[0].positions.size(), simulation.state().positions.size());
  } catch (const std::runtime_error&) {
  }
}

TEST(SavedStates, ThatAreCutShortOrTooLongOrForeignAreRefused) {
  const scene::Scene scene = support::scene_of_text(kThinJaws);
  production::SceneSimulation simulation(scene);
  for (int k = 0; k < 6; ++k) simulation.advance();
  std::string bytes;
  simulation.save(bytes);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 150) {
    production::SceneSimulation other(scene);
    EXPECT_THROW(other.restore(std::string_view(bytes).substr(0, size)), std::runtime_error) << size;
  }
  production::SceneSimulation longer(scene), foreign(support::scene_of_text(kDrape));
  EXPECT_THROW(longer.restore(bytes + "x"), std::runtime_error);
  EXPECT_THROW(foreign.restore(bytes), std::runtime_error);
}

TEST(SavedStates, WithAnyByteChangedDoNoHarm) {
  const scene::Scene scene = support::scene_of_text(kThinJaws, {"contact.response=velocity_constraints"});
  production::SceneSimulation simulation(scene);
  for (int k = 0; k < 8; ++k) simulation.advance();
  std::string bytes;
  simulation.save(bytes);
  const std::size_t every = 1 + bytes.size() / 250;
  for (std::size_t i = 0; i < bytes.size(); i += every)
    for (char flip : {char(0x01), char(0x80), char(0xFF)}) {
      std::string broken = bytes;
      broken[i] = static_cast<char>(broken[i] ^ flip);
      try_bytes(scene, broken);
    }
}

}  // namespace
}  // namespace weft::simulation
