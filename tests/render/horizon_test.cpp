// Tests the floor near the horizon, at the scale of kilometres, and from below.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

/// Floor as seen by a low eye, before anything stands on it.
frame::FrameSnapshot wide_floor() {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_floor(snapshot).appearance.color = Vec3::Constant(0.6);
  snapshot.cameras = {camera_at(Vec3(0, 0, 1.7), Vec3(0, 10, 1.65), 30)};
  snapshot.lights = {sun(Vec3(0.5, 0.5, -1))};
  return snapshot;
}

/// Expects that wide_floor() has one colour up to the horizon and the backdrop another.
void expect_horizon(const frame::FrameSnapshot& snapshot, Quality quality) {
  const image::Image image = drawn(snapshot, 2, quality);
  // Row of the horizon, counted from the top: above the middle by 0.005 / tan 15° of half the height.
  const int horizon = static_cast<int>(image.height / 2 * (1 - 0.005 / std::tan(15 * std::numbers::pi / 180)));
  for (int y = horizon + 3; y < image.height; ++y)
    EXPECT_NEAR(image.pixel(160, y)[1], image.pixel(160, image.height - 1)[1], 1.5) << y;
  EXPECT_GT(std::abs(image.pixel(160, horizon - 20)[1] - image.pixel(160, image.height - 1)[1]), 8);
}

// The surroundings are a thousand times as large as the height of the eye: the floor fades within the last pixel below
// the horizon, and shows its plain light in all other pixels. If the fading were computed on a grid of 16 pixels, it
// would extend over up to 16 pixels.
TEST(Picture, FloorOfHugeSurroundingsFadesAtTheHorizonOnly) {
  frame::FrameSnapshot snapshot = wide_floor();
  for (const double side : {-1, 1})
    add_square(snapshot, frame::ObjectKind::obstacle, Vec3(1700 * side, 0, 1), Vec3::UnitZ(), Vec3::UnitX(), 1);
  for (const Quality quality : {Quality::preview, Quality::final}) expect_horizon(snapshot, quality);
}

// In a run, a square moves by kilometres. In each frame, the floor reaches as far as the fading, to the horizon.
TEST(Picture, FloorOfALongRunReachesTheHorizon) {
  frame::FrameSnapshot snapshot = wide_floor();
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0, 1), Vec3::UnitZ(), Vec3::UnitX(), 0.5).run_bounds =
      Box3(Vec3(-1700, -0.5, 1), Vec3(1700, 0.5, 1));
  expect_horizon(snapshot, Quality::preview);
}

// The drawn floor extends for 130 km. At this distance, single precision rounds by millimetres.
TEST(Picture, TiltedFloorOfKilometresIsDrawn) {
  constexpr int kTilts = 8;
  for (int k = 0; k < kTilts; ++k) {
    const double tilt = std::numbers::pi / 9, turn = 2 * std::numbers::pi * k / kTilts;
    const Vec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    const Vec3 across = normal.cross(Vec3::UnitY()).normalized(), away = normal.cross(across);
    const Vec3 place = 1234.5 * across, target = place + 350 * away;
    frame::FrameSnapshot snapshot;
    snapshot.stage = stage_without_sky();
    frame::Surface& floor = add_square(snapshot, frame::ObjectKind::obstacle, place, normal, across, 5);
    floor.infinite_floor = true;
    floor.appearance.color = Vec3::Constant(0.6);
    add_square(snapshot, frame::ObjectKind::obstacle, place + normal, normal, across, 200);
    snapshot.cameras = {camera_at(place + 1000 * normal + 1500 * away, target, 20)};
    snapshot.lights = {sun(-normal)};
    Settings settings;
    settings.width = 32;
    settings.height = 20;
    settings.quality = Quality::draft;
    // If the floor were missing, this pixel would show the backdrop, which is 20 levels darker.
    EXPECT_NEAR(Renderer(settings).draw(snapshot).pixel(16, 10)[1], 0.6 * 255, 4) << k;
  }
}

TEST(Picture, WhatIsBelowTheFloorIsVisibleFromBelow) {
  frame::FrameSnapshot snapshot;
  add_floor(snapshot);
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0, -1), -Vec3::UnitZ(), Vec3::UnitX(), 0.5)
      .appearance.color = Vec3(0.8, 0.1, 0.1);
  snapshot.cameras = {camera_at(Vec3(0, 0, -3), Vec3::Zero(), 30)};
  snapshot.lights = {sun(Vec3::UnitZ())};
  Settings settings;
  settings.width = settings.height = 32;
  const image::Image image = Renderer(settings).draw(snapshot);
  EXPECT_GT(image.pixel(16, 16)[0], image.pixel(16, 16)[2] + 50);
}

}  // namespace
}  // namespace weft::render
