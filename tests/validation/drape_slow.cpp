// The sheet that falls on a sphere: how high it comes to lie, whether it rests, and how much its threads give.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "validation/every_frame.hpp"

namespace weft::simulation {
namespace {

struct Drape {
  double height = 0;      // mean over all particles in the last frame [m]
  double hem_height = 0;  // mean over the border
  double stretch = 1;     // largest in any frame
  double rms_speed = 0;   // largest of the last second [m/s]
  double cpu_s = 0;
};

/// The sheet falls on the top of the sphere: without noise it stays symmetric for a while, buckles by what rounding
/// says, and comes to lie anywhere between 0.151 and 0.158 m. With a micrometre of it (1 to 8 µm were tried) it lies at
/// 0.1527 to 0.1538 m, and with an eighth of the step at 0.1534 to 0.1541 m.
constexpr double kStartNoise = 1e-6;  // [m]

bool on_border(std::size_t particle, std::size_t n) {
  const std::size_t i = particle % n, j = particle / n;
  return i == 0 || j == 0 || i + 1 == n || j + 1 == n;
}

Drape drape_with(double step_factor) {
  scene::Scene scene = testing::scene_of({"sphere_drape", 1, -1});
  scene.time.step *= step_factor;
  scene.cloths[0].start_noise = kStartNoise;
  const auto frames = support::run_scene(scene, {.judged = false});
  Drape drape;
  for (const support::MeasuredFrame& frame : frames) {
    drape.stretch = std::max(drape.stretch, frame.max_stretch);
    drape.cpu_s += frame.report.simulate_cpu_s;
    if (frame.report.time > scene.time.duration - 1 + 1e-9)
      drape.rms_speed = std::max(drape.rms_speed, frame.rms_speed);
  }
  const auto& x = frames.back().cloths[0];
  const auto n = static_cast<std::size_t>(scene.cloths[0].particles_weft);
  double border = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    drape.height += x[i].z() / static_cast<double>(x.size());
    if (on_border(i, n)) drape.hem_height += x[i].z(), ++border;
  }
  drape.hem_height /= border;
  std::printf(
      "step %g s: mean height %.6f m, of the hem %.6f m, stretch %.4f, rms speed of the last second up to %.3g "
      "m/s, %.1f CPU ms a frame\n",
      scene.time.step, drape.height, drape.hem_height, drape.stretch, drape.rms_speed,
      1e3 * drape.cpu_s / (scene.frame_count() - 1));
  return drape;
}

// The height of the drape is the mean over the whole sheet, 0.152 m: what the folds do with the hem changes from step
// to step, for the sheet buckles into them.
TEST(Drape, LiesAsHighAsWithAnEighthOfTheStep) {
  const double fine = drape_with(1.0 / 8).height;
  EXPECT_NEAR(drape_with(1).height, fine, 0.01 * fine);
  for (double factor : {2.0, 4.0}) drape_with(factor);  // for their figures
}

TEST(Drape, ComesToRestWithItsThreadsHardlyStretched) {
  const Drape drape = drape_with(1);
  EXPECT_LT(drape.stretch, 1.05);
  EXPECT_LT(drape.rms_speed, 1e-3);
}

}  // namespace
}  // namespace weft::simulation
