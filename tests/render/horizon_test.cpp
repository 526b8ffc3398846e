// Tests open floor near the horizon.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

constexpr int kPictureWidth = 320, kPictureHeight = 200;

// The surroundings are a thousand times as large as the height of the eye: the floor fades within the last pixel below
// the horizon, and shows its plain light in all other pixels. If the fading were computed on a grid of 16 pixels, it
// would extend over up to 16 pixels.
TEST(Picture, FloorOfHugeSurroundingsFadesAtTheHorizonOnly) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_floor(snapshot).appearance.color = Vec3::Constant(0.6);
  for (const double side : {-1, 1})
    add_square(snapshot, frame::ObjectKind::obstacle, Vec3(1700 * side, 0, 1), Vec3::UnitZ(), Vec3::UnitX(), 1);
  snapshot.cameras = {camera_at(Vec3(0, 0, 1.7), Vec3(0, 10, 1.65), 30)};
  snapshot.lights = {sun(Vec3(0.5, 0.5, -1))};
  // Row of the horizon, counted from the top: 0.005 / tan 15° of half a picture above the middle.
  const int horizon = static_cast<int>(kPictureHeight / 2 * (1 - 0.005 / std::tan(15 * std::numbers::pi / 180)));
  for (const Quality quality : {Quality::preview, Quality::final}) {
    Settings settings;
    settings.width = kPictureWidth;
    settings.height = kPictureHeight;
    settings.quality = quality;
    const image::Image image = Renderer(settings).draw(snapshot);
    for (int y = horizon + 3; y < kPictureHeight; ++y)
      EXPECT_NEAR(image.pixel(160, y)[1], image.pixel(160, kPictureHeight - 1)[1], 1.5) << y;
    EXPECT_GT(std::abs(image.pixel(160, horizon - 20)[1] - image.pixel(160, kPictureHeight - 1)[1]), 8);
  }
}

}  // namespace
}  // namespace weft::render
