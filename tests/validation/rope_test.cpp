// Compares ropes with theory: hanging, vibration, fall, and friction on a drum.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "film/scene/ropes.hpp"
#include "support/scene_runs.hpp"

namespace weft {
namespace {

using support::MeasuredFrame;

constexpr double kGravity = 9.81;

std::string rope(const std::string& name, const std::string& keys) {
  return "[[rope]]\nname = \"" + name + "\"\n" + keys;
}

TEST(Ropes, HangAsACatenaryAndPullAtTheirEndsWithItsForce) {
  // The rope of 60 pieces of 25 mm starts as a V. Tolerance: lumped masses deviate from the catenary by up to the sag
  // of a piece, (25 mm)² / 8 a = 0.2 mm; the remaining motion is smaller.
  constexpr double kSpan = 1, kLength = 1.5, kMass = 0.05, kStretch = 2000, kPiece = kLength / 60;
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 4\nstep = 0.02\n" +
      rope("line",
           "points = [[-0.5, 0, 0], [0, 0, -0.559], [0.5, 0, 0]]\nlength = 1.5\nsegments = 60\ndiameter = 0.006\n"
           "mass = 0.05\nstretch = 2000\nbend = 0\ndrag = 4\ndamping = 0.05\npin = [{ at = 0 }, { at = 1 }]\n"));
  const std::vector<Vec3> x = support::run_scene(scene, {.counts_intersections = false}).back().cloths.at(0);
  // Newton's method for sinh(u) / u = length / span, where u = span / 2a.
  double u = 1;
  for (int k = 0; k < 50; ++k) u -= (std::sinh(u) - kLength / kSpan * u) / (std::cosh(u) - kLength / kSpan);
  const double a = kSpan / (2 * u);
  for (const Vec3& place : x) EXPECT_NEAR(place.z(), a * (std::cosh(place.x() / a) - std::cosh(u)), 1e-3);
  // The tension of the first piece has two components: the weight of the rope below its middle, and the tension at the
  // lowest point, which is horizontal.
  const double pull = kStretch * ((x[1] - x[0]).norm() / kPiece - 1);
  const double expected = kMass * kGravity * std::hypot(a, 0.5 * (kLength - kPiece));
  EXPECT_NEAR(pull / expected, 1, 0.01);
}

TEST(Ropes, SwingWithTheFrequencyOfATautString) {
  // The frequency, 5 Hz, has an error of 3e-4 from its 40 pieces, and of 3e-4 from steps of 2 ms.
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.6\nfps = 250\nstep = 0.002\nintegrator = \"implicit_midpoint\"\n"
      "[physics]\ngravity = [0, 0, 0]\nair_density = 0\n[contact]\nself = false\n" +
      rope("string",
           "from = [0, 0, 0]\nto = [1, 0, 0]\nlength = 0.99\nsegments = 40\ndiameter = 0.002\nmass = 0.01\n"
           "stretch = 100\nbend = 0\ndamping = 0\nvelocity = [0, 0, 0.02]\npin = [{ at = 0 }, { at = 1 }]\n"));
  std::vector<double> crossings;
  double before = 0;
  for (const MeasuredFrame& frame :
       support::run_scene(scene, {.counts_intersections = false, .keep_positions = true})) {
    double amplitude = 0;
    for (const Vec3& x : frame.cloths.at(0)) amplitude += x.z() * std::sin(std::numbers::pi * x.x());
    const double t = frame.report.frame / 250.0;
    if (before * amplitude < 0) crossings.push_back(t - amplitude / (amplitude - before) / 250);
    before = amplitude;
  }
  ASSERT_GE(crossings.size(), 4U);
  const double frequency = 0.5 * static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
  const double tension = 100 * (1 / 0.99 - 1), mass = 0.01 * 0.99;
  EXPECT_NEAR(frequency / (0.5 * std::sqrt(tension / mass)), 1, 2e-3);
}

TEST(Ropes, FallFreelyHoweverTheyBendAndSwingWithinThemselves) {
  // The midpoint rule is exact for the motion of the centre of mass. Tolerance: the residual of the solver.
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.4\nstep = 0.005\nintegrator = \"implicit_midpoint\"\n[physics]\nair_density = 0\n"
      "[contact]\nself = false\n[solver]\nnewton_tolerance = 1e-6\nlinear_tolerance = 1e-3\n" +
      rope("lasso",
           "points = [[0, 0, 0], [0.2, 0.1, 0], [0.3, -0.1, 0.1], [0.5, 0, 0.2]]\nsmooth = true\nlength = 0.7\n"
           "diameter = 0.006\nvelocity = [1, 0.5, 2]\n"));
  const std::vector<MeasuredFrame> frames =
      support::run_scene(scene, {.counts_intersections = false, .keep_positions = true});
  const std::vector<double> lengths = scene::start_shape(scene.ropes[0], scene.up).lengths;
  const auto centre = [&](const std::vector<Vec3>& x) {
    Vec3 sum = Vec3::Zero();
    double all = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      sum += 0.5 * lengths[i] * (x[i] + x[i + 1]);
      all += lengths[i];
    }
    return Vec3(sum / all);
  };
  const Vec3 start = centre(frames.front().cloths.at(0));
  for (const MeasuredFrame& frame : frames) {
    const double t = frame.report.frame / 25.0;
    const Vec3 expected = start + t * Vec3(1, 0.5, 2) - 0.5 * kGravity * t * t * Vec3::UnitZ();
    EXPECT_LT((centre(frame.cloths.at(0)) - expected).norm(), 1e-6) << "at " << t << " s";
  }
}

/// A rope over half of a fixed drum, with a friction coefficient of 0.2 and masses at its ends.
scene::Scene over_a_drum(double light, double heavy) {
  constexpr double kRadius = 0.1, kCourse = 0.1035;  // radii of the drum and of the rope's centre line around it [m]
  std::string points = fmt::format("[{}, 0, -0.5]", -kCourse);
  for (int k = 0; k <= 24; ++k) {
    const double angle = std::numbers::pi * (1 - k / 24.0);
    points += fmt::format(", [{}, 0, {}]", kCourse * std::cos(angle), kCourse * std::sin(angle));
  }
  points += fmt::format(", [{}, 0, -0.5]", kCourse);
  return support::scene_of_text(
      "[time]\nduration = 0.8\nstep = 0.005\n[physics]\nair_density = 0\n" +
      rope("line", "points = [" + points + "]\ndiameter = 0.006\nmass = 0.005\nbend = 0\nfriction = 0.2\n" +
                       fmt::format("weight = [{{ at = 0, mass = {} }}, {{ at = 1, mass = {} }}]\n", light, heavy)) +
      fmt::format("[[obstacle]]\nname = \"drum\"\nshape = \"cylinder\"\nradius = {}\nheight = 0.1\nsegments = 128\n"
                  "rotation = [90, 0, 0]\nfriction = 0.2\n",
                  kRadius));
}

// How far the heavy end descends between 0.1 s, when the rope has stretched, and 0.8 s [m].
double descent(const scene::Scene& scene) {
  const std::vector<MeasuredFrame> frames =
      support::run_scene(scene, {.counts_intersections = false, .keep_positions = true});
  return frames[2].cloths.at(0).back().z() - frames.back().cloths.at(0).back().z();
}

TEST(Ropes, SlipOverADrumFromTheRatioOfLoadsOnThatEulerAndEytelweinHave) {
  // The rope slips if the mass ratio r exceeds e^(μ π) = 1.874. With r 3 % larger, it accelerates by g (r − 1.874) / (1
  // + r) = 0.19 m/s², and moves by 5 cm in 0.7 s.
  const double ratio = std::exp(0.2 * std::numbers::pi);
  EXPECT_LT(descent(over_a_drum(0.5, 0.97 * 0.5 * ratio)), 0.01);
  EXPECT_GT(descent(over_a_drum(0.5, 1.03 * 0.5 * ratio)), 0.03);
}

TEST(Ropes, StayOnTheSideOfAnotherRopeOnWhichTheyFall) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.8\nstep = 0.01\n" +
      rope("held", "from = [-0.4, 0, 0]\nto = [0.4, 0, 0]\ndiameter = 0.008\npin = [{ at = 0 }, { at = 1 }]\n") +
      rope("falling", "from = [0.01, -0.4, 0.15]\nto = [0.01, 0.4, 0.15]\ndiameter = 0.008\n"));
  const std::vector<MeasuredFrame> frames = support::run_scene(scene, {.keep_positions = true});
  for (const MeasuredFrame& frame : frames) {
    EXPECT_EQ(frame.pairs, 0U) << frame.between;
    // The point of the upper rope that crosses the other rope, seen from above. If several do, it is the highest: the
    // ends of the upper rope hang down and swing below the other rope.
    const std::vector<Vec3>&held = frame.cloths.at(0), &falling = frame.cloths.at(1);
    std::optional<Vec3> over;
    for (std::size_t i = 1; i < falling.size(); ++i) {
      if (falling[i - 1].y() * falling[i].y() > 0) continue;
      const double s = falling[i - 1].y() / (falling[i - 1].y() - falling[i].y());
      const Vec3 place = falling[i - 1] + s * (falling[i] - falling[i - 1]);
      if (!over || place.z() > over->z()) over = place;
    }
    ASSERT_TRUE(over);
    for (std::size_t k = 1; k < held.size(); ++k)
      if (held[k - 1].x() <= over->x() && over->x() < held[k].x()) {
        EXPECT_GT(over->z() - std::max(held[k - 1].z(), held[k].z()), 0.004);
      }
  }
  const std::vector<Vec3>& last = frames.back().cloths.at(1);
  EXPECT_GT(last[last.size() / 2].z(), -0.2) << "it hangs over the other";
  EXPECT_LT(last.front().z(), -0.2);
}

TEST(Ropes, LieOnClothAndBodiesWithoutPassingThroughThem) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 1.2\nstep = 0.01\n"
      "[[cloth]]\nname = \"sheet\"\nsize = [0.6, 0.6]\nparticles = [25, 25]\nposition = [0, 0, 0.24]\n"
      "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.2\n"
      "[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\nposition = [0, 0, -0.25]\n" +
      rope("loop",
           "points = [[0.15, 0, 0.35], [0, 0.15, 0.35], [-0.15, 0, 0.35], [0, -0.15, 0.35]]\nsmooth = true\n"
           "closed = true\ndiameter = 0.01\n") +
      rope("line", "from = [-0.5, 0.05, 0.45]\nto = [0.5, 0.05, 0.45]\ndiameter = 0.008\n"));
  for (const MeasuredFrame& frame : support::run_scene(scene)) EXPECT_EQ(frame.pairs, 0U) << frame.between;
}

}  // namespace
}  // namespace weft
