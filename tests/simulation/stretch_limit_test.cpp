// Cloth whose threads lock: what pulls at it, and what is said where nothing holds.
#include <gtest/gtest.h>

#include "simulation/saved_state.hpp"
#include "simulation/scenes.hpp"
#include "simulation/simulation.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

// A sheet that hangs from its upper border; a ball as wide as a third of it comes at 4 m/s, halfway up.
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

// Its lower border is drawn down to one and a half times its length, slowly.
constexpr const char* kTornApart = R"(
[time]
duration = 0.8
[contact]
self = false
[[cloth]]
name = "banner"
size = [0.2, 0.4]
particles = [5, 9]
position = [0, 0, 2]
rotation = [90, 0, 0]
material = { max_stretch = 0.1 }
[[cloth.pin]]
low = [0, 1]
high = [1, 1]
[[cloth.pin]]
low = [0, 0]
high = [1, 0]
keys = [{ time = 0, position = [0, 0, 0] }, { time = 0.8, position = [0, 0, -0.2] }]
)";

// Likewise, with a plate that comes at 30 m/s and goes on: 0.3 m in a step.
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

double largest_share(const scene::Scene& scene, std::vector<std::string>& said) {
  Simulation simulation(scene);
  double share = 0;
  for (int k = 1; k < scene.frame_count(); ++k) {
    const FrameReport report = simulation.advance();
    share = std::max(share, report.stretch_share);
    said.insert(said.end(), report.warnings.begin(), report.warnings.end());
  }
  return share;
}

// Of 47 starts with gravity from 9.6 to 10 m/s² one is stretched to 1.1003 times the limit, where a step pushes it
// apart, all others to 0.82 at most.
TEST(StretchLimitInAScene, IsKeptWhereABallStrikesAHangingSheet) {
  std::vector<std::string> said;
  int beyond = 0;
  for (const char* gravity : {"-9.8", "-9.81", "-9.82", "-9.83"}) {
    const double share =
        largest_share(support::scene_of_text(kImpact, {std::string("physics.gravity=[0,0,") + gravity + "]"}), said);
    EXPECT_LT(share, 1.2) << gravity;
    beyond += share > 0.9;
  }
  EXPECT_LE(beyond, 1);
  EXPECT_LE(std::ssize(said), beyond);
  // By 1.9 to 2.1 %, with gravity from 9.6 to 10 m/s², and by 3.7 to 6.1 % where the limit is far away.
  EXPECT_GT(9 * largest_share(support::scene_of_text(kImpact, {"cloth.sheet.material.max_stretch=9"}), said), 0.035);
}

TEST(StretchLimitInAScene, GoesOnFromASavedState) {
  const testing::Continued continued = testing::continue_runs(support::scene_of_text(kImpact), {6, {0, 1, 2, 4}});
  EXPECT_EQ(continued.difference, "");
}

// In steps of 10 ms it was stretched to 23 and 22 times its limit, since it cannot slip past the plate in one; now
// to 3.5 and 4.9 in single short steps.
TEST(StretchLimitInAScene, IsKeptBeforeAPlateThatComesAt30MetresASecond) {
  std::vector<std::string> said;
  for (const char* gravity : {"-9.81", "-9.82"})
    EXPECT_LT(largest_share(support::scene_of_text(struck_by_a_plate(gravity)), said), 8) << gravity;
}

TEST(StretchLimitInAScene, TellsOnceWhereItCannotBeKept) {
  std::vector<std::string> said;
  EXPECT_GT(largest_share(support::scene_of_text(kTornApart), said), 4);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("'banner' is stretched by "), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("max_stretch 0.1"), std::string::npos) << said[0];
  // Pulled as far again after it was let go.
  said.clear();
  std::string pulled = kTornApart;
  const std::string once = "{ time = 0.8, position = [0, 0, -0.2] }";
  pulled.replace(pulled.find(once), once.size(),
                 "{ time = 0.2, position = [0, 0, -0.06] }, { time = 0.4, position = [0, 0, 0.02] }, "
                 "{ time = 0.6, position = [0, 0, -0.06] }");
  EXPECT_GT(largest_share(support::scene_of_text(pulled.c_str()), said), 1.1);
  EXPECT_EQ(said.size(), 1U);
}

TEST(StretchLimitInAScene, ChangesNothingBelowItsOnset) {
  scene::Scene with = testing::sheet_alone(0.5, 9, 1);
  scene::Pin pin;
  pin.low = {0, 1}, pin.high = {1, 1};
  with.cloths[0].pins = {pin};
  scene::Scene without = with;
  with.cloths[0].material.max_stretch = 0.1, with.cloths[0].material.max_shear = 45;
  Simulation a(with), b(without);
  for (int k = 0; k < 5; ++k) {
    const FrameReport of_a = a.advance(), of_b = b.advance();
    EXPECT_EQ(of_b.stretch_share, 0);
    ASSERT_LT(of_a.stretch_share, 0.6);
    EXPECT_EQ(testing::sheet_of(a.snapshot()), testing::sheet_of(b.snapshot()));
  }
}

}  // namespace
}  // namespace weft::simulation
