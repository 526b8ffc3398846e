// Tests of cloth with locking threads under impacts and pulls, and of the warnings if its stretch limit is exceeded.
#include <gtest/gtest.h>

#include "film/production/scene_simulation.hpp"
#include "simulation/saved_state.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

// A sheet hangs from its upper border; a ball a third as wide hits it halfway up at 4 m/s.
constexpr const char* kImpact = R"(
[time]
duration = 0.24
step = 0.002
[[cloth]]
name = "sheet"
size = [0.6, 0.6]
particles = [17, 17]
position = [0, 0, 2]
rotation = [90, 0, 0]
pin = [{ low = [0, 1], high = [1, 1] }]
material = { max_stretch = 0.025, max_shear = 45 }
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
keys = [{ time = 0, position = [0, -0.2, 2] }, { time = 0.12, position = [0, 0.28, 2] }]
)";

// Keys that pull a border down by half of the length of its sheet, 0.4 m.
constexpr const char* kHalfItsLength = "{ time = 0 }, { time = 0.8, offset = [0, 0, -0.2] }";

// A sheet hangs at x = `x` [m]; `keys` move its lower border.
std::string pulled_down(const std::string& name, const std::string& x, const std::string& keys) {
  return "[[cloth]]\nname = '" + name + "'\nsize = [0.2, 0.4]\nparticles = [5, 9]\nposition = [" + x +
         ", 0, 2]\nrotation = [90, 0, 0]\nmaterial = { max_stretch = 0.1 }\npin = [{ low = [0, 1], high = [1, 1] }, "
         "{ low = [0, 0], high = [1, 0], keys = [" +
         keys + "] }]\n";
}
constexpr const char* kWithoutSelfContact = "[time]\nduration = 0.8\n[contact]\nself = false\n";

// A plate hits a hanging sheet at 30 m/s, which is 0.3 m per step, and moves on.
std::string struck_by_a_plate(const char* gravity) {
  return std::string("[time]\nduration = 0.32\n[physics]\ngravity = [0, 0, ") + gravity + R"(]
[[cloth]]
name = "sheet"
size = [1, 1]
particles = [21, 21]
position = [0, 0, 1.5]
rotation = [90, 0, 0]
pin = [{ low = [0, 1], high = [1, 1] }]
[[obstacle]]
name = "plate"
shape = "box"
size = [0.3, 0.02, 0.3]
interpolation = "linear"
keys = [{ time = 0.1, position = [0, -1.5, 1.4] }, { time = 0.2, position = [0, 1.5, 1.4] }]
)";
}

double max_stretch_ratio(const scene::Scene& scene, std::vector<std::string>& seen_warnings) {
  production::SceneSimulation simulation(scene);
  double ratio = 0;
  for (int k = 1; k < scene.frame_count(); ++k) {
    const FrameReport report = simulation.advance();
    ratio = std::max(ratio, report.stretch_ratio);
    seen_warnings.insert(seen_warnings.end(), report.warnings.begin(), report.warnings.end());
  }
  return ratio;
}

// Measured for 47 values of gravity from 9.6 to 10 m/s²: the sheet stretches to at most 0.82 times the limit; in one
// run to 1.1003 times the limit, in a step that pushes the sheet out of a contact.
TEST(StretchLimitInAScene, IsKeptWhereABallStrikesAHangingSheet) {
  std::vector<std::string> seen_warnings;
  int beyond = 0;
  for (const char* gravity : {"-9.8", "-9.81", "-9.82", "-9.83"}) {
    const double ratio = max_stretch_ratio(
        support::scene_of_text(kImpact, {std::string("physics.gravity=[0,0,") + gravity + "]"}), seen_warnings);
    EXPECT_LT(ratio, 1.2) << gravity;
    beyond += ratio > 0.9;
  }
  EXPECT_LE(beyond, 1);
  EXPECT_LE(std::ssize(seen_warnings), beyond);
  // Without the limit the sheet stretches by 3.7 to 6.1 %, with it by 1.9 to 2.1 % (gravity from 9.6 to 10 m/s²).
  EXPECT_GT(
      9 * max_stretch_ratio(support::scene_of_text(kImpact, {"cloth.sheet.material.max_stretch=9"}), seen_warnings),
      0.035);
}

TEST(StretchLimitInAScene, GoesOnFromASavedState) {
  const testing::ContinuationResult continued =
      testing::continue_runs(support::scene_of_text(kImpact), {6, {0, 1, 2, 4}});
  EXPECT_EQ(continued.difference, "");
}

// Within one step of 10 ms the sheet cannot slip past the plate: for the two values of gravity, it would stretch to 23
// and 22 times the limit. Shorter steps keep it to 3.5 and 4.9 times the limit, and exceed the limit in single steps
// only (measured).
TEST(StretchLimitInAScene, IsKeptBeforeAPlateThatComesAt30MetresASecond) {
  std::vector<std::string> seen_warnings;
  for (const char* gravity : {"-9.81", "-9.82"})
    EXPECT_LT(max_stretch_ratio(support::scene_of_text(struck_by_a_plate(gravity)), seen_warnings), 8) << gravity;
}

TEST(StretchLimitInAScene, WarnsOnceIfItCannotBeKept) {
  const auto of_banner = [](const std::string& keys) {
    return support::scene_of_text(kWithoutSelfContact + pulled_down("banner", "0", keys));
  };
  std::vector<std::string> seen_warnings;
  EXPECT_GT(max_stretch_ratio(of_banner(kHalfItsLength), seen_warnings), 4);
  ASSERT_EQ(seen_warnings.size(), 1U);
  EXPECT_NE(seen_warnings[0].find("'banner' is stretched by "), std::string::npos) << seen_warnings[0];
  EXPECT_NE(seen_warnings[0].find("max_stretch 0.1"), std::string::npos) << seen_warnings[0];
  // The border is pulled down, released, and pulled down again: there is still only one warning.
  seen_warnings.clear();
  const double again = max_stretch_ratio(
      of_banner("{ time = 0 }, { time = 0.2, offset = [0, 0, -0.06] }, { time = 0.4, offset = [0, 0, 0.02] }, "
                "{ time = 0.6, offset = [0, 0, -0.06] }"),
      seen_warnings);
  EXPECT_GT(again, 1.4);
  EXPECT_EQ(seen_warnings.size(), 1U);
}

// The sheet starts at 1.3 times its length along the warp, three times its limit.
TEST(StretchLimitInAScene, IsMeasuredAtTheStart) {
  scene::Scene scene = testing::sheet_alone(0.5, 5, 1);
  scene.cloths[0].material.max_stretch = 0.1;
  scene.cloths[0].start_scale = {1, 1.3};
  EXPECT_NEAR(production::SceneSimulation(scene).initial_report().stretch_ratio, 3, 1e-9);
}

// The first sheet stays stretched by 15 % while the second one is pulled down.
TEST(StretchLimitInAScene, WarnsOfEachCloth) {
  std::vector<std::string> seen_warnings;
  max_stretch_ratio(
      support::scene_of_text(kWithoutSelfContact +
                             pulled_down("first", "0", "{ time = 0 }, { time = 0.2, offset = [0, 0, -0.06] }") +
                             pulled_down("second", "1", "{ time = 0.4 }, { time = 0.6, offset = [0, 0, -0.06] }")),
      seen_warnings);
  ASSERT_EQ(seen_warnings.size(), 2U);
  EXPECT_NE(seen_warnings[0].find("'first' is stretched by "), std::string::npos) << seen_warnings[0];
  EXPECT_NE(seen_warnings[1].find("'second' is stretched by "), std::string::npos) << seen_warnings[1];
}

TEST(StretchLimitInAScene, ChangesNothingBelowItsOnset) {
  scene::Scene with = testing::sheet_alone(0.5, 9, 1);
  scene::Pin pin;
  pin.low = {0, 1}, pin.high = {1, 1};
  with.cloths[0].pins = {pin};
  scene::Scene without = with;
  with.cloths[0].material.max_stretch = 0.1, with.cloths[0].material.max_shear = 45;
  production::SceneSimulation a(with), b(without);
  for (int k = 0; k < 5; ++k) {
    const FrameReport of_a = a.advance(), of_b = b.advance();
    EXPECT_EQ(of_b.stretch_ratio, 0);
    ASSERT_LT(of_a.stretch_ratio, 0.6);
    EXPECT_EQ(testing::sheet_of(a.snapshot()), testing::sheet_of(b.snapshot()));
  }
}

}  // namespace
}  // namespace weft::simulation
