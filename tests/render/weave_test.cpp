// Yarns of cloth, seen from nearby and from far away.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

/// Cloth that fills the picture, tilted back by `degrees`, seen from a distance [m]. `thread_spacing` [m]; 0: no
/// threads.
frame::FrameSnapshot leaning_cloth(double distance, double thread_spacing, Threads threads = Threads::plain,
                                   double degrees = 50) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  const double angle = degrees * std::numbers::pi / 180;
  const double half = 10;
  frame::Surface& cloth = add_square(snapshot, frame::ObjectKind::cloth, Vec3::Zero(),
                                     Vec3(0, -std::cos(angle), std::sin(angle)), Vec3::UnitX(), half);
  cloth.appearance.color = Vec3(0.6, 0.4, 0.3);
  cloth.appearance.thread_spacing = thread_spacing;
  cloth.appearance.finish.threads = threads;
  cloth.uv = {{0, 0}, {2 * half, 0}, {2 * half, 2 * half}, {0, 2 * half}};
  snapshot.cameras = {camera_at(Vec3(0, -distance, 0), Vec3::Zero(), 30)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

// The level of the mean linear light in the middle of a picture; the mean of the levels would be lower.
double mean_light(const image::Image& image) {
  constexpr double kGamma = 2.2;
  double sum = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 30; x < 130; ++x) sum += std::pow(image.pixel(x, y)[1] / 255.0, kGamma) / 10000;
  return 255 * std::pow(sum, 1 / kGamma);
}

TEST(Weave, KeepsTheMeanColorNearAndFar) {
  const double bare = mean_light(drawn(leaning_cloth(1, 0), 1));
  for (const double spacing : {0.0001, 0.0006, 0.03})
    // Tolerance [levels]: a picture that shows few threads contains some yarns more often than others.
    EXPECT_NEAR(mean_light(drawn(leaning_cloth(1, spacing), 1)), bare, 4) << spacing;
  for (const Threads threads : {Threads::twill, Threads::denim, Threads::knit, Threads::none})
    EXPECT_NEAR(mean_light(drawn(leaning_cloth(1, 0.03, threads), 1)), bare, 4) << static_cast<int>(threads);
}

// Correlation of a picture with itself, displaced by this number of threads (of eight pixels) to the right and up; 1 if
// they are equal.
double alike(const image::Image& image, int right, int up) {
  constexpr int kThread = 8;
  double mean = 0, square = 0, product = 0, count = 0;
  const auto at = [&](int x, int y) { return double(image.pixel(x, y)[1]); };
  for (int y = 30; y < 70; ++y)
    for (int x = 40; x < 120; ++x) mean += at(x, y) / (40 * 80);
  for (int y = 30; y < 70; ++y)
    for (int x = 40; x < 120; ++x, ++count) {
      square += (at(x, y) - mean) * (at(x, y) - mean);
      product += (at(x, y) - mean) * (at(x + kThread * right, y - kThread * up) - mean);
    }
  return product / square;
}

// The lines of a twill rise to the right; a plain weave is symmetric; the stitches of a knit form
// columns one thread wide.
TEST(Weave, LiesAsTheThreadsOfTheFabricDo) {
  const double spacing = 8 * 2 * std::tan(15 * std::numbers::pi / 180) / 100;
  const auto seen = [&](Threads threads) { return drawn(leaning_cloth(1, spacing, threads, 0), 1); };
  const image::Image plain = seen(Threads::plain), twill = seen(Threads::twill), denim = seen(Threads::denim),
                     knit = seen(Threads::knit);
  EXPECT_GT(alike(plain, 1, 1), 0.7);
  EXPECT_GT(alike(plain, 1, -1), 0.7);
  for (const image::Image* each : {&twill, &denim}) {
    EXPECT_GT(alike(*each, 1, 1), 0.7);
    EXPECT_LT(alike(*each, 1, -1), 0.5);
  }
  EXPECT_GT(alike(knit, 1, 0), 0.7);
  EXPECT_LT(alike(twill, 1, 0), 0.5);
}

// If threads are smaller than a pixel, the picture must equal their mean, as in a picture of six times the resolution,
// without moiré. Measured difference: 0.4 to 1.3 levels, of which dither and rounding to bytes make 0.4; without
// fading, 14 to 16.
TEST(Weave, HasNoBeats) {
  constexpr int kFiner = 6;
  constexpr double kSpacing = 0.0006;
  for (double distance = 0.26; distance < 21; distance *= 2.62) {
    const frame::FrameSnapshot snapshot = leaning_cloth(distance, kSpacing);
    const image::Image image = drawn(snapshot, 1), finer = drawn(snapshot, kFiner);
    double squares = 0;
    for (int y = 10; y < 90; ++y)
      for (int x = 30; x < 130; ++x)
        squares += std::pow(image.pixel(x, y)[1] - mean(finer, kFiner * x, kFiner * y, kFiner), 2) / 8000;
    EXPECT_LT(std::sqrt(squares), 2) << distance;
  }
}

}  // namespace
}  // namespace weft::render
