// Translucent cloth, and floors that reflect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "film/render/mirror.hpp"
#include "film/render/renderer.hpp"
#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

/// A red wall seen from the front.
frame::FrameSnapshot wall() {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3::Zero(), -Vec3::UnitY(), Vec3::UnitX(), 3).appearance.color =
      Vec3(0.8, 0.1, 0.1);
  snapshot.cameras = {camera_at(Vec3(0, -4, 0), Vec3::Zero(), 30)};
  snapshot.lights = {sun(Vec3(0.3, 1, 0))};
  return snapshot;
}

/// Adds a blue veil at y [m], in front of the wall. `sheer`: Finish::sheer.
void hang(frame::FrameSnapshot& snapshot, double y, double sheer) {
  frame::Surface& veil =
      add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, y, 0), -Vec3::UnitY(), Vec3::UnitX(), 0.5);
  veil.appearance.color = veil.appearance.back_color = Vec3(0.1, 0.1, 0.8);
  veil.appearance.finish = {0, 0.5, 0, sheer};
}

double linear(int byte) {
  return std::pow((byte / 255.0 + 0.055) / 1.055, 2.4);
}

TEST(Sheer, CloseWeavesHideWhatIsBehindAndOpenOnesHalf) {
  frame::FrameSnapshot bare = wall(), dense = wall(), veiled = wall();
  hang(dense, -1, 0.5);
  hang(veiled, -1, 0.9);
  const image::Image red = drawn(bare, 1), blue = drawn(dense, 1), both = drawn(veiled, 1);
  // The dense veil transmits almost no red.
  EXPECT_LT(blue.pixel(80, 50)[0], 90);
  // The open veil transmits half of the wall's red. Its shadow makes the wall darker.
  const double through = linear(both.pixel(80, 50)[0]) / linear(red.pixel(80, 50)[0]);
  EXPECT_GT(through, 0.25);
  EXPECT_LT(through, 0.55);
  EXPECT_GT(both.pixel(80, 50)[2], red.pixel(80, 50)[2] + 40);
  // Beside the veil, nothing must change.
  for (int k = 0; k < 3; ++k) EXPECT_EQ(both.pixel(8, 50)[k], red.pixel(8, 50)[k]);
}

TEST(Sheer, TheOrderOfVeilsInTheSceneDoesNotMatter) {
  frame::FrameSnapshot front_first = wall(), back_first = wall();
  hang(front_first, -1, 0.9);
  hang(front_first, -0.5, 0.8);
  hang(back_first, -0.5, 0.8);
  hang(back_first, -1, 0.9);
  const image::Image a = drawn(front_first, 1), b = drawn(back_first, 1);
  for (int x = 20; x < 140; x += 5)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(a.pixel(x, 50)[k], b.pixel(x, 50)[k]) << x;
  // Two veils hide more than one.
  frame::FrameSnapshot one = wall();
  hang(one, -1, 0.9);
  EXPECT_LT(a.pixel(80, 50)[0], drawn(one, 1).pixel(80, 50)[0] - 10);
}

TEST(Sheer, ItsShadowIsPaler) {
  const auto light = [](std::optional<double> sheer) {
    frame::FrameSnapshot snapshot;
    snapshot.stage = stage_without_sky();
    add_floor(snapshot);
    if (sheer)
      add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0, 1), Vec3::UnitZ(), Vec3::UnitX(), 0.4)
          .appearance.finish = {0, 0.5, 0, *sheer};
    snapshot.cameras = {camera_at(Vec3(0, -3, 0.7), Vec3(0, 0, 0.4), 40)};
    snapshot.lights = {sun(-Vec3::UnitZ())};
    return linear(drawn(snapshot, 1).pixel(80, 68)[1]);
  };
  const double open = light(std::nullopt);
  EXPECT_LT(light(0.3), 0.05 * open);
  EXPECT_NEAR(light(0.9) / open, 0.5, 0.12);
}

frame::FrameSnapshot ball_on_floor(double roughness) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  add_floor(snapshot).appearance.roughness = roughness;
  frame::Surface& ball = add_sphere(snapshot, Vec3(0, 0, 0.5), 0.3, 24);
  ball.appearance.color = Vec3(0.9, 0.05, 0.05);
  snapshot.cameras = {camera_at(Vec3(0, -4, 0.4), Vec3(0, 0, 0.2), 30)};
  return snapshot;
}

/// Excess of red over green of a pixel.
int redness(const image::Image& image, int x, int y) {
  return image.pixel(x, y)[0] - image.pixel(x, y)[1];
}

TEST(Mirror, FloorsThatAreSmoothShowWhatStandsOnThem) {
  const image::Image smooth = drawn(ball_on_floor(0.1), 1), rough = drawn(ball_on_floor(0.6), 1);
  // The centre of the ball is 0.5 m above the floor, and its mirror image 0.5 m below; both are in the middle column.
  const int mirrored_row = 50 + static_cast<int>(std::lround(0.7 / 4 / std::tan(15 * std::acos(-1.0) / 180) * 50));
  EXPECT_GT(redness(smooth, 80, mirrored_row), redness(rough, 80, mirrored_row) + 5);
  EXPECT_LE(std::abs(redness(smooth, 10, mirrored_row) - redness(rough, 10, mirrored_row)), 3);
  // Reflections are drawn only in final quality.
  EXPECT_LE(redness(drawn(ball_on_floor(0.1), 1, Quality::preview), 80, mirrored_row),
            redness(rough, 80, mirrored_row) + 3);
}

TEST(Mirror, AViewFromBelowMeetsWhatTheFloorReflects) {
  Floor floor;
  floor.point = Vec3(0, 0, 0.2);
  View view;
  view.eye = Vec3(1, -3, 1.5);
  view.axes = view_axes(Vec3(-1, 3, -0.8), Vec3::UnitZ());
  view.tan_half_width = 0.5;
  view.tan_half_height = 0.3;
  view.near = 0.1;
  view.far = 100;
  view.view_from_world = look_along(view.eye, view.axes);
  view.clip_from_world = perspective(0.5, 0.3, 0.1) * view.view_from_world;
  const View below = mirror_view(view, floor);
  // The view from below shows a point where the original view shows its mirror image, but upside down: in the same
  // column, in the opposite row, at the same distance.
  for (const Vec3& p : {Vec3(0.1, 0.2, 0.5), Vec3(-0.4, 1, 0.3)}) {
    const Vec3 image(p.x(), p.y(), 0.4 - p.z());
    const Eigen::Vector4d seen = view.clip_from_world * image.homogeneous(),
                          from = below.clip_from_world * p.homogeneous();
    EXPECT_NEAR(seen.x() / seen.w(), from.x() / from.w(), 1e-9);
    EXPECT_NEAR(seen.y() / seen.w(), -from.y() / from.w(), 1e-9);
    EXPECT_NEAR(seen.w(), from.w(), 1e-9);
  }
}

// Below a ball that almost touches the floor, in the shadow of a sheet, few pixels show floor over which the noise of
// traced light can be averaged. If a pixel is brighter or darker than both pixels at a distance of two, one of the
// differences must be at most 2 levels.
TEST(Occlusion, HasNoStreaksWhereABallTouchesTheFloor) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  add_floor(snapshot);
  add_sphere(snapshot, Vec3(0, 0, 0.205), 0.2, 40);
  add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0, 0.45), Vec3::UnitZ(), Vec3::UnitX(), 0.5);
  snapshot.cameras = {camera_at(Vec3(1.75, -1.55, 1.05), Vec3(0, 0, 0.17), 26)};
  snapshot.lights = {sun(Vec3(-0.75, -0.1, -1.1))};
  Settings settings;
  settings.width = 1280;
  settings.height = 720;
  const image::Image image = Renderer(settings).draw(snapshot);
  int worst = 0;
  for (int y = 468; y < 486; ++y) {
    for (int x = 560; x < 716; ++x) {
      const auto level = [&](int k) { return static_cast<int>(image.pixel(x + k, y)[1]); };
      worst = std::max(worst, std::min(std::abs(level(0) - level(-2)), std::abs(level(0) - level(2))) *
                                  ((level(0) - level(-2)) * (level(0) - level(2)) > 0 ? 1 : 0));
    }
  }
  EXPECT_LE(worst, 2);
}

// From top to bottom, each column leaves a shadow once, so its level must not fall by more than the noise (5 levels).
// Otherwise, the almost horizontal edge of the shadow would look dashed.
TEST(Shadows, EdgesThatRunNearlyLevelAreNotDashed) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  add_floor(snapshot);
  add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0.3, 0.1), Vec3::UnitZ(), Vec3(1, 0.03, 0), 0.5);
  snapshot.cameras = {camera_at(Vec3(0, -5, 1.5), Vec3(0, -0.34, 0), 30)};
  snapshot.lights = {sun(Vec3(0, -1.4, -1))};
  snapshot.lights[0].softness = 0.3;
  Settings settings;
  settings.width = 1280;
  settings.height = 720;
  const image::Image image = Renderer(settings).draw(snapshot);
  int worst = 0;
  for (int x = 560; x < 720; ++x) {
    int darkest = 255, brightest = 0;
    for (int y = 350; y < 500; ++y) {
      const int level = image.pixel(x, y)[1];
      worst = std::max(worst, brightest - level);
      brightest = std::max(brightest, level);
      darkest = std::min(darkest, level);
    }
    EXPECT_GT(brightest, darkest + 50);
  }
  EXPECT_LE(worst, 5);
}

}  // namespace
}  // namespace weft::render
