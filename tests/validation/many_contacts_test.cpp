// Scenes dominated by contact: layered sheets, a heap of ribbons, a belt, a wrung tube. Meshes are coarse, so that runs
// are quick; the motions are as large as with a fine mesh.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/intersections.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

class ManyContacts : public support::TestFolder {
 protected:
  /// Writes a tube about the y axis as an OBJ file and returns the keys of a cloth with this shape.
  std::string tube(double radius, double length, int around, int along) const {
    std::string text;
    for (int j = 0; j < along; ++j) {
      for (int i = 0; i < around; ++i) {
        const double angle = 2 * std::numbers::pi * i / around;
        text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", radius * std::cos(angle),
                            length * (static_cast<double>(j) / (along - 1) - 0.5), radius * std::sin(angle));
      }
    }
    for (int j = 0; j + 1 < along; ++j) {
      for (int i = 0; i < around; ++i) {
        const int a = j * around + i + 1, b = j * around + (i + 1) % around + 1, c = a + around, d = b + around;
        text += (i + j) % 2 == 1 ? fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", a, c, d, b)
                                 : fmt::format("f {0} {2} {3}\nf {3} {2} {1}\n", a, d, c, b);
      }
    }
    const auto file = folder_ / "tube.obj";
    support::write_bytes(file, text);
    return fmt::format("[[cloth]]\nname = 'tube'\nshape = 'mesh'\nrest = 'mesh'\nfile = '{}'\n", file.string());
  }

  /// Runs the scene and expects no intersection in any frame. The same scene must have intersections if contacts are
  /// off; otherwise the test would show nothing. One of its 80 to 120 steps may be halved. (Of six starts of the
  /// ribbons, 0.7 mm apart in height, one has such a step.)
  static void expect_apart(const std::string& text) {
#ifndef NDEBUG
    GTEST_SKIP() << "takes long with sanitizers";
#endif
    int rejected = 0;
    support::run_scene(support::scene_of_text(text), {}, [&](const support::MeasuredFrame& frame) {
      EXPECT_EQ(frame.pairs, 0U) << "frame " << frame.report.frame << ": " << frame.between;
      rejected += frame.report.rejected_steps;
    });
    EXPECT_LE(rejected, 1);

    const scene::Scene free = support::scene_of_text(text, {"contact.self=false", "contact.obstacles=false"});
    production::SceneSimulation simulation(free);
    std::size_t pairs = 0;
    for (int frame = 1; frame < free.frame_count() && pairs == 0; ++frame) {
      simulation.advance();
      pairs = support::find_intersections(support::objects_of(*simulation.snapshot())).pairs.size();
    }
    EXPECT_GT(pairs, 0U);
  }
};

// Five sheets, each held at two corners, over a body.
std::string sheets_over(const std::string& body) {
  std::string text = "[time]\nduration = 1.0\n";
  for (int i = 0; i < 5; ++i) {
    text += fmt::format(
        "[[cloth]]\nname = 'sheet_{}'\nsize = [1, 1]\nparticles = [13, 13]\nposition = [0.01, 0.007, {:.3f}]\n"
        "rotation = [0, 0, {}]\npin = [{{ low = [0, 0], high = [0, 0] }}, {{ low = [1, 1], high = [1, 1] }}]\n",
        i, 0.62 + 0.015 * i, 9 * i);
  }
  return text + "[[obstacle]]\nname = 'body'\nposition = [0, 0, 0.35]\n" + body;
}

TEST_F(ManyContacts, OfFiveSheetsOnASphereKeepThemApart) {
  expect_apart(sheets_over("shape = 'sphere'\nradius = 0.25\n"));
}

TEST_F(ManyContacts, OfFiveSheetsOnTheTipOfAConeKeepThemApart) {
  expect_apart(sheets_over("shape = 'cone'\nradius = 0.25\nheight = 0.5\n"));
}

TEST_F(ManyContacts, OfABallThatGoesThroughEightHangingSheetsKeepThemApart) {
  std::string text =
      "[time]\nduration = 0.8\n"
      "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nradius = 0.12\ninterpolation = 'linear'\n"
      "keys = [{ time = 0, position = [0.02, -0.2, 0.5] }, { time = 0.8, position = [0.02, 1.2, 0.5] }]\n";
  for (int i = 0; i < 8; ++i) {
    text += fmt::format(
        "[[cloth]]\nname = 'sheet_{}'\nsize = [0.5, 0.5]\nparticles = [11, 11]\nposition = [0, {:.3f}, 0.6]\n"
        "rotation = [90, 0, 0]\npin = [{{ low = [0, 1], high = [1, 1] }}]\n",
        i, 0.015 * i);
  }
  expect_apart(text);
}

TEST_F(ManyContacts, OfNineRibbonsThatFallIntoAHalfPipeKeepThemApart) {
  std::string text =
      "[time]\nduration = 0.8\n"
      "[[obstacle]]\nname = 'pipe'\nshape = 'half_pipe'\nradius = 0.3\nlength = 0.7\nposition = [0, 0, 0.4]\n";
  for (int i = 0; i < 9; ++i) {
    text += fmt::format(
        "[[cloth]]\nname = 'ribbon_{}'\nsize = [0.06, 1.2]\nparticles = [3, 31]\n"
        "position = [{:.2f}, {:.2f}, 0.8]\nrotation = [{}, 0, {}]\n",
        i, 0.1 * (i % 3 - 1), 0.08 * (i / 3 - 1), 88 + i % 2, 17 * i - 60);
  }
  expect_apart(text);
}

// The belt starts as a ring. Three rollers inside it move outward until it is taut; they turn all the time.
TEST_F(ManyContacts, OfABeltRoundThreeTurningRollersKeepThemApart) {
  constexpr double kRing = 0.3, kRoller = 0.06;  // radii [m]
  constexpr double kInside = kRing - kRoller - 0.005;
  // At this distance from the middle the path around the rollers, 2 π kRoller + 3 √3 taut, is as long as the ring.
  const double taut = 2 * std::numbers::pi * (kRing - kRoller) / (3 * std::numbers::sqrt3);
  std::string text = "[time]\nduration = 1.2\n" + tube(kRing, 0.12, 64, 5) + "material = { friction = 0.6 }\n";
  for (int i = 0; i < 3; ++i) {
    const double angle = std::numbers::pi * (0.5 + 2.0 * i / 3);
    const auto at = [&](double distance) {
      return fmt::format("position = [{:.5f}, 0, {:.5f}]", distance * std::cos(angle), distance * std::sin(angle));
    };
    text += fmt::format(
        "[[obstacle]]\nname = 'roller_{}'\nshape = 'cylinder'\nradius = {}\nheight = 0.2\nfriction = 0.6\n"
        "interpolation = 'linear'\nkeys = [{{ time = 0, {}, rotation = [90, 0, 0] }}, "
        "{{ time = 0.6, {}, rotation = [90, 270, 0] }}, {{ time = 1.2, {}, rotation = [90, 540, 0] }}]\n",
        i, kRoller, at(kInside), at(taut), at(taut));
  }
  expect_apart(text);
}

TEST_F(ManyContacts, OfATubeThatIsWrungFromBothEndsKeepItApart) {
  std::string text = "[time]\nduration = 1.2\n" + tube(0.06, 0.5, 20, 25) + "material = { fabric = 'silk' }\n";
  for (const int end : {0, 1}) {
    const int sign = end == 0 ? 1 : -1;
    text += fmt::format(
        "[[cloth.pin]]\nlow = [0, {0}]\nhigh = [1, {0}]\ninterpolation = 'linear'\n"
        "keys = [{{ time = 0 }}, {{ time = 1.2, offset = [0, {1}, 0], rotation = [0, {2}, 0] }}]\n",
        end, 0.03 * sign, -300 * sign);
  }
  expect_apart(text);
}

}  // namespace
}  // namespace weft::simulation
