// Tests of layered garments, which are dressed one after the other, each outside the one below.
#include "film/scene/layers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "film/production/scene_simulation.hpp"
#include "simulation/saved_state.hpp"
#include "support/intersections.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

// Text of an OBJ file of a tube around z, stretched along x by the factor `ellipse`. `flipped`: its faces point to the
// axis.
std::string tube(double radius, double height, double ellipse = 1, bool flipped = false) {
  constexpr int kAround = 28, kUp = 9;
  std::string text;
  for (int j = 0; j < kUp; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", radius * ellipse * std::cos(angle),
                          radius / ellipse * std::sin(angle), height * (static_cast<double>(j) / (kUp - 1) - 0.5));
    }
  }
  for (int j = 0; j + 1 < kUp; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i + 1, b = j * kAround + (i + 1) % kAround + 1, c = a + kAround, d = b + kAround;
      text += flipped ? fmt::format("f {} {} {}\nf {} {} {}\n", d, b, a, c, d, a)
                      : fmt::format("f {} {} {}\nf {} {} {}\n", a, b, d, a, d, c);
    }
  }
  return text;
}

/// Number of times that the ray from p, away from the z axis, pierces a surface.
int count_crossings(const Vec3& p, const std::vector<std::array<Index, 3>>& triangles, const std::vector<Vec3>& x) {
  const Vec3 outward = 10 * Vec3(p.x(), p.y(), 0).normalized();
  int times = 0;
  for (const auto& [a, b, c] : triangles) {
    const double u = outward.dot((x[b] - p).cross(x[c] - p)), v = outward.dot((x[c] - p).cross(x[a] - p)),
                 w = outward.dot((x[a] - p).cross(x[b] - p));
    const Vec3 n = (x[b] - x[a]).cross(x[c] - x[a]);
    const double at = n.dot(x[a] - p) / n.dot(outward);
    times += ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) && at > 0;
  }
  return times;
}

class Layers : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    support::write_bytes(folder_ / "vest.obj", tube(0.165, 0.5));
    support::write_bytes(folder_ / "shirt.obj", tube(0.160, 0.45, 1, true));
    support::write_bytes(folder_ / "coat.obj", tube(0.175, 0.4, 1.12));
  }

  /// The coat is first in the file and dressed last; it crosses the vest. The shirt is inside out, and inside the vest.
  scene::Scene dressed(const std::string& time) const {
    const auto cloth = [&](const std::string& name, const std::string& over) {
      return "[[cloth]]\nname = '" + name + "'\nshape = 'mesh'\nfile = '" + (folder_ / (name + ".obj")).string() +
             "'\nmaterial = { thickness = 0.004 }\n" + over;
    };
    return support::scene_of_text(
        "[time]\nduration = 0.4\n" + time + cloth("coat", "over = 'shirt'\n") + cloth("vest", "") +
        cloth("shirt", "over = ['vest']\n") +
        "[[obstacle]]\nname = 'body'\nshape = 'cylinder'\nradius = 0.15\nheight = 0.9\nsegments = 28\n");
  }
};

TEST_F(Layers, ThatCrossOrLieTheWrongWayAroundGetOutsideOfWhatTheyAreWornOver) {
  for (const char* time : {"", "preroll = 0.36\n"}) {
    const scene::Scene scene = dressed(time);
    production::SceneSimulation simulation(scene);
    ASSERT_TRUE(simulation.run_preroll());
    for (int frame = 0; frame < 4; ++frame) {
      const frame::SnapshotPtr now = simulation.snapshot();
      EXPECT_EQ(support::find_intersections(support::objects_of(*now)).pairs.size(), 0U) << time << "frame " << frame;
      for (const auto& [inner, outer] : {std::pair{1, 2}, std::pair{2, 0}, std::pair{1, 0}}) {
        int inside = 0;
        for (const Vec3& p : now->states[outer].positions)
          inside += count_crossings(p, now->surfaces[inner]->triangles, now->states[inner].positions) % 2;
        EXPECT_EQ(inside, 0) << time << "frame " << frame << ", " << outer << " over " << inner;
      }
      simulation.advance();
    }
  }
}

TEST_F(Layers, ComeAfterEachOtherAndAreNotThereBefore) {
  scene::Scene scene = dressed("preroll = 0.36\n");
  // There is no friction, because the shirt grips the vest so tightly that friction would make its motion chaotic.
  for (scene::Cloth& cloth : scene.cloths) cloth.material.friction = 0;
  for (scene::Obstacle& obstacle : scene.obstacles) obstacle.friction = 0;
  const std::vector<scene::Layer> layers = scene::list_layers(scene);
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[1].first_frame, -6);
  EXPECT_EQ(layers[1].put_on, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(layers[2].cloths, std::vector<std::size_t>{0});
  // Until the shirt is dressed, the vest falls as it does alone.
  scene::Scene alone = scene;
  alone.cloths = {scene.cloths[1]};
  production::SceneSimulation one(alone), three(scene);
  const std::size_t vest = alone.cloths.empty() ? 0 : one.particles();
  for (int frame = 0; frame < 3; ++frame) {
    one.advance(), three.advance();
    EXPECT_EQ(three.state().positions.size(), vest);
    EXPECT_EQ(one.snapshot()->states[0].positions, three.snapshot()->states[1].positions) << frame;
  }
  // Then the vest keeps the speed that it has alone. If dressing stopped it, it would have a quarter of that speed.
  one.advance(), three.advance();
  EXPECT_EQ(three.state().positions.size(), 2 * vest);
  const auto speed = [&](const production::SceneSimulation& simulation) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < vest; ++i) sum += simulation.state().velocities[i];
    return sum.z();
  };
  EXPECT_NEAR(speed(three) / speed(one), 1, 0.25);
}

/// Results of a run in which jaws pinch a sheet, and a ram pushes its pinned edge away. `more`: a further cloth that is
/// dressed over the sheet.
struct HeldUp {
  std::vector<int> pinched, lagging;  // per frame
  std::vector<std::string> warnings;
  std::vector<Vec3> end;  // positions of the sheet [m]
};
HeldUp hold_up(const std::string& more) {
  // The tolerance is tight, because another cloth changes the residual of the solver.
  const scene::Scene scene = support::scene_of_text(R"(
[solver]
newton_tolerance = 0.03
[time]
preroll = 0.8
duration = 0.4
)" + more + R"(
[[cloth]]
name = "sheet"
size = [0.4, 0.4]
particles = [17, 17]
position = [0, 0, 0.6]
rotation = [90, 0, 0]
pin = [{ low = [0, 1], high = [1, 1] }]
[[obstacle]]
name = "ram"
shape = "box"
size = [0.6, 0.2, 0.1]
keys = [{ time = -0.8, position = [0, 0.2, 0.8] }, { time = -0.5, position = [0, 0.05, 0.8] }]
[[obstacle]]
name = "left"
shape = "box"
size = [0.2, 0.2, 0.2]
keys = [{ time = -0.8, position = [0.02, -0.25, 0.5] }, { time = -0.5, position = [0.02, -0.095, 0.5] }]
[[obstacle]]
name = "right"
shape = "box"
size = [0.2, 0.2, 0.2]
keys = [{ time = -0.8, position = [-0.02, 0.25, 0.48] }, { time = -0.5, position = [-0.02, 0.095, 0.48] }]
)");
  production::SceneSimulation simulation(scene);
  HeldUp held;
  for (int frame = -20; frame < 10; ++frame) {
    const FrameReport report = simulation.advance();
    held.pinched.push_back(report.pinched_pairs);
    held.lagging.push_back(report.lagging_particles);
    held.warnings.insert(held.warnings.end(), report.warnings.begin(), report.warnings.end());
  }
  held.end = simulation.snapshot()->states[scene.cloths.size() - 1].positions;
  return held;
}

// If another cloth is dressed, pinching and lagging of the first cloth continue, and are not reported again.
TEST_F(Layers, PinchedAndHeldUpGoOnSoWhenTheNextComes) {
  const HeldUp alone = hold_up(""), below = hold_up(
                                        "[[cloth]]\nname = 'coat'\nover = 'sheet'\nsize = [0.1, 0.1]\n"
                                        "particles = [3, 3]\nposition = [3, 0, 0]\n");
  ASSERT_GT(alone.pinched[9], 50);
  ASSERT_EQ(alone.lagging[9], 17);
  EXPECT_EQ(below.warnings, alone.warnings);
  EXPECT_EQ(below.lagging, alone.lagging);
  for (std::size_t k = 0; k < alone.pinched.size(); ++k)
    EXPECT_NEAR(below.pinched[k], alone.pinched[k], 0.2 * alone.pinched[k]) << "frame " << k;
  // Tolerances: with one more cloth, the solver stops at another iterate. Measured: at most a ninth of the pinched
  // pairs differ, and positions at the end differ by up to 11 mm, for a swinging sheet of 0.4 m.
  for (std::size_t i = 0; i < alone.end.size(); ++i) EXPECT_LT((alone.end[i] - below.end[i]).norm(), 0.02);
}

// The lid, a sheet that lies across the tube of the vest, cannot be moved to the outside of the vest.
TEST_F(Layers, ThatCannotBePutOnLeaveWhatIsWornAsItWas) {
  production::SceneSimulation simulation(
      support::scene_of_text("[time]\npreroll = 0.36\n[physics]\ngravity = [0, 0, 0]\n"
                             "[[cloth]]\nname = 'vest'\nshape = 'mesh'\nfile = '" +
                             (folder_ / "vest.obj").string() +
                             "'\n[[cloth]]\nname = 'lid'\nover = 'vest'\nsize = [0.6, 0.6]\nparticles = [25, 25]\n"));
  const std::size_t vest = simulation.particles();
  int frames = 0;
  const auto failure = [&]() -> std::string {
    try {
      for (; frames < 9; ++frames) simulation.advance();
    } catch (const Error& error) {
      return error.what();
    }
    return "no failure";
  };
  const std::string first = failure();
  const int good = frames;
  EXPECT_NE(first.find("lid"), std::string::npos) << first;
  EXPECT_EQ(failure(), first);
  EXPECT_EQ(frames, good);
  EXPECT_EQ(simulation.particles(), vest);
}

TEST_F(Layers, SavedInThePrerollGoOnAsIfNothingHadBeen) {
  const testing::ContinuationResult run = testing::continue_runs(dressed("preroll = 0.36\n"), {10, {2, 3, 6}});
  EXPECT_EQ(run.difference, "");
}

TEST_F(Layers, ShareTheTimeInWhichCharactersStandStill) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\npreroll = 3\n[[character]]\nname = 'she'\nsource = 'mannequin'\ndressing = 2\nblend = 1\n"
      "[[cloth]]\nname = 'a'\nover = 'b'\n[[cloth]]\nname = 'b'\n");
  EXPECT_EQ(scene::list_layers(scene)[1].first_frame, -50);
}

TEST(LayersOfAScene, WithoutOrderAreOne) {
  const std::vector<scene::Layer> layers =
      scene::list_layers(support::scene_of_text("[[cloth]]\nname = 'a'\n[[cloth]]\nname = 'b'\n"));
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_EQ(layers[0].cloths.size(), 2U);
}

}  // namespace
}  // namespace weft::simulation
