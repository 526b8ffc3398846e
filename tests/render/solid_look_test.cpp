// Appearance of bodies: metal, a clear coat, heat of ropes, and pictures on floors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "film/image/color.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

constexpr int kSide = 160;  // width and height of a picture [pixels]

Settings settings(Quality quality = Quality::draft) {
  Settings result;
  result.width = result.height = kSide;
  result.quality = quality;
  return result;
}

/// A red ball that fills most of the picture, in a studio. `gloss`: strength of the clear coat.
frame::FrameSnapshot ball(double metal, double gloss, double roughness) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  frame::Appearance& look = add_sphere(snapshot, Vec3::Zero(), 0.5, 40).appearance;
  look.color = Vec3(0.7, 0.15, 0.1);
  look.metal = metal;
  look.coat = gloss;
  look.roughness = roughness;
  snapshot.cameras = {camera_at(Vec3(0, -2, 0), Vec3::Zero(), 35)};
  return snapshot;
}

image::Image draw(const frame::FrameSnapshot& snapshot, Quality quality = Quality::draft) {
  return Renderer(settings(quality)).draw(snapshot);
}

struct Range {
  double lowest = 255, highest = 0;  ///< of the green channel, in the middle of the ball
};
Range green_of(const image::Image& image) {
  Range range;
  for (int y = kSide / 4; y < 3 * kSide / 4; ++y)
    for (int x = kSide / 4; x < 3 * kSide / 4; ++x) {
      range.lowest = std::min<double>(range.lowest, image.pixel(x, y)[1]);
      range.highest = std::max<double>(range.highest, image.pixel(x, y)[1]);
    }
  return range;
}

TEST(Metal, ScattersNoLight) {
  // The only light is a sun at the left, so the part of the ball that faces the camera reflects the dark surroundings.
  const auto middle = [](double metal) {
    frame::FrameSnapshot snapshot = ball(metal, 0, 0.1);
    snapshot.stage = stage_without_sky();
    snapshot.lights = {sun(Vec3(1, 1, 0))};
    const image::Image image = draw(snapshot);
    const std::uint8_t* pixel = image.pixel(kSide / 2, kSide / 2);
    return std::array<int, 3>{pixel[0], pixel[1], pixel[2]};
  };
  EXPECT_LT(middle(1)[0], 12);
  EXPECT_GT(middle(0)[0], 100);
}

TEST(Metal, ReflectsInItsOwnColor) {
  // Ratio of red to green light of a ball with this colour.
  const auto redness = [](double metal, const Vec3& color) {
    frame::FrameSnapshot snapshot = ball(metal, 0, 0.3);
    const_cast<frame::Surface&>(*snapshot.surfaces[0]).appearance.color = color;
    const image::Image image = draw(snapshot);
    double red = 0, green = 0;
    for (int y = kSide / 3; y < 2 * kSide / 3; ++y)
      for (int x = kSide / 3; x < 2 * kSide / 3; ++x) {
        red += image::linear_from_srgb(image.pixel(x, y)[0] / 255.0);
        green += image::linear_from_srgb(image.pixel(x, y)[1] / 255.0);
      }
    return red / green;
  };
  const Vec3 copper(0.9, 0.5, 0.4);
  const double own = image::linear_from_srgb(copper.x()) / image::linear_from_srgb(copper.y());
  EXPECT_NEAR(redness(1, copper) / redness(1, Vec3(0.9, 0.9, 0.9)), own, 0.2 * own);
  EXPECT_GT(redness(1, copper), 1.03 * redness(0, copper)) << "there white light comes from the surface";
}

TEST(Coat, AddsAHighlightAndLeavesTheColorBelow) {
  const Range plain = green_of(draw(ball(0, 0, 0.9))), coated = green_of(draw(ball(0, 1, 0.9)));
  EXPECT_GT(coated.highest, plain.highest + 40);
  EXPECT_NEAR(coated.lowest, plain.lowest, 12);
}

TEST(Coat, AndMetalAreNoneInClay) {
  auto shiny = ball(1, 1, 0.1), plain = ball(0, 0, 0.1);
  for (auto* snapshot : {&shiny, &plain}) {
    auto stage = std::make_shared<frame::Stage>();
    stage->look = frame::Stage::Look::clay;
    snapshot->stage = stage;
  }
  EXPECT_EQ(draw(shiny).rgb, draw(plain).rgb);
}

TEST(FloorColor, IsThatOfClayInClay) {
  const auto on_floor = [](frame::Stage::Look look, const Vec3& color) {
    frame::FrameSnapshot snapshot = ball(0, 0, 0.6);
    auto stage = std::make_shared<frame::Stage>();
    stage->look = look;
    snapshot.stage = stage;
    add_floor(snapshot).appearance.color = color;
    snapshot.cameras = {camera_at(Vec3(0, -3, 1), Vec3::Zero(), 50)};
    return draw(snapshot).rgb;
  };
  const Vec3 red(0.8, 0.1, 0.1), gray(0.8, 0.8, 0.8);
  EXPECT_NE(on_floor(frame::Stage::Look::studio, red), on_floor(frame::Stage::Look::studio, gray));
  EXPECT_EQ(on_floor(frame::Stage::Look::clay, red), on_floor(frame::Stage::Look::clay, gray));
}

TEST(Look, OfOneBodyLeavesThatOfOthers) {
  // Two balls are side by side. `metal`: of the right one.
  const auto pair = [](double metal) {
    frame::FrameSnapshot snapshot = ball(0, 0, 0.6);
    add_sphere(snapshot, Vec3(2, 0, 0), 0.5, 40).appearance.metal = metal;
    snapshot.cameras = {camera_at(Vec3(1, -5, 0), Vec3(1, 0, 0), 35)};
    return draw(snapshot);
  };
  const image::Image plain = pair(0), metal = pair(1);
  int most = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide / 2 - 10; ++x)
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(plain.pixel(x, y)[c] - metal.pixel(x, y)[c]));
  // Tolerance [levels]: a metal ball scatters no light onto the other ball.
  EXPECT_LE(most, 2);
  EXPECT_NE(plain.rgb, metal.rgb);
}

// A body of two tetrahedra, of which the right one, which is smaller, is inside out. Both show their lit near sides.
TEST(Shells, ThatAreInsideOutAreSeenFromOutside) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  const std::vector<Vec3> corners{{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}};
  std::vector<Vec3> positions;
  for (const Vec3& corner : corners) positions.emplace_back(corner - Vec3(2, 0, 0));
  for (const Vec3& corner : corners) positions.emplace_back(0.8 * corner + Vec3(2, 0, 0));
  add_surface(snapshot, frame::ObjectKind::obstacle, positions,
              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {6, 4, 5}, {5, 4, 7}, {6, 5, 7}, {4, 6, 7}});
  snapshot.cameras = {camera_at(Vec3(0, -12, 0), Vec3::Zero(), 40)};
  snapshot.lights = {sun(Vec3::UnitY())};
  const image::Image image = draw(snapshot);
  EXPECT_GT(image.pixel(41, 86)[1], 100);
  EXPECT_NEAR(image.pixel(118, 85)[1], image.pixel(41, 86)[1], 3);
}

// Ropes have heat, which also determines the scale if Stage::heat_max is 0. Tolerance [levels]: solid surfaces have no
// threads and fibres.
TEST(Heat, IsShownByRopesAsByCloth) {
  for (const float share : {0.0f, 0.5f, 1.0f}) {
    std::vector<image::Image> images;
    for (const auto kind : {frame::ObjectKind::cloth, frame::ObjectKind::rope}) {
      frame::FrameSnapshot snapshot;
      auto stage = stage_without_sky();
      stage->heat = frame::Stage::Heat::speed;
      stage->heat_max = 2;
      snapshot.stage = stage;
      add_square(snapshot, kind, Vec3::Zero(), -Vec3::UnitY(), Vec3::UnitX(), 0.5);
      snapshot.states[0].heat.assign(4, 2 * share);
      snapshot.cameras = {camera_at(Vec3(0, -2, 0), Vec3::Zero(), 35)};
      snapshot.lights = {sun(Vec3::UnitY())};
      images.push_back(draw(snapshot));
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(images[1].pixel(kSide / 2, kSide / 2)[c], images[0].pixel(kSide / 2, kSide / 2)[c], 5) << share;
  }
}

/// A floor of 10 m, seen from above, with a picture of two by two fields on each square metre. The front of the scene
/// is at the bottom of the picture.
frame::FrameSnapshot tiled_floor() {
  constexpr std::array<std::array<std::uint8_t, 4>, 4> kFields{
      {{180, 20, 20, 255}, {20, 180, 20, 255}, {20, 20, 180, 255}, {180, 180, 180, 255}}};
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  frame::Surface& floor = add_floor(snapshot);
  floor.paint_uv = {{Vec2(0, 0), Vec2(10, 0), Vec2(10, 10)}, {Vec2(0, 0), Vec2(10, 10), Vec2(0, 10)}};
  frame::Texture picture{64, 64, {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const auto& field = kFields[static_cast<std::size_t>(y / 32 * 2 + x / 32)];
      picture.rgba.insert(picture.rgba.end(), field.begin(), field.end());
    }
  floor.appearance.paint.texture = std::make_shared<const frame::Texture>(std::move(picture));
  floor.appearance.color = Vec3(0.5, 0.5, 0.5);
  // A floor alone is no subject, so the scene has a small ball in the middle of the picture.
  add_sphere(snapshot, Vec3(0.5, 0.5, 0.02), 0.02, 6);
  snapshot.cameras = {camera_at(Vec3(0.5, 0.499, 3), Vec3(0.5, 0.5, 0), 18.4)};  // 0.97 m wide at the floor
  return snapshot;
}

TEST(FloorPicture, LiesUprightOnItsTiles) {
  for (const Quality quality : {Quality::draft, Quality::final}) {
    const image::Image image = draw(tiled_floor(), quality);
    const auto strongest = [&](double x, double y) {
      const std::uint8_t* pixel = image.pixel(static_cast<int>(x * kSide), static_cast<int>(y * kSide));
      if (pixel[0] > pixel[1] + 30 && pixel[0] > pixel[2] + 30) return 'r';
      if (pixel[1] > pixel[0] + 30 && pixel[1] > pixel[2] + 30) return 'g';
      if (pixel[2] > pixel[0] + 30 && pixel[2] > pixel[1] + 30) return 'b';
      return 'w';
    };
    EXPECT_EQ(strongest(0.25, 0.25), 'r');
    EXPECT_EQ(strongest(0.75, 0.25), 'g');
    EXPECT_EQ(strongest(0.25, 0.75), 'b');
    EXPECT_EQ(strongest(0.75, 0.75), 'w');
  }
}

}  // namespace
}  // namespace weft::render
