// Pictures on surfaces: position, minification, and transparency.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "film/image/color.hpp"
#include "film/render/opacity.hpp"
#include "film/render/painted_mesh.hpp"
#include "film/render/reflected_light.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

using Alpha = frame::Paint::Alpha;
constexpr int kPaintedSide = 160;  // width and height of a picture [pixels]

Settings painted_settings(Quality quality = Quality::final) {
  Settings result;
  result.width = kPaintedSide;
  result.height = kPaintedSide;
  result.quality = quality;
  return result;
}

/// A texture of coloured fields in rows from the top. Each field has `size` x `size` texels. With the default size, the
/// texture filter of llvmpipe stays within one field.
std::shared_ptr<const frame::Texture> texture(int columns, int rows,
                                              const std::vector<std::array<std::uint8_t, 4>>& fields, int size = 32) {
  frame::Texture made{columns * size, rows * size, {}};
  for (int y = 0; y < made.height; ++y) {
    for (int x = 0; x < made.width; ++x) {
      const auto& pixel = fields[static_cast<std::size_t>(y / size * columns + x / size)];
      made.rgba.insert(made.rgba.end(), pixel.begin(), pixel.end());
    }
  }
  return std::make_shared<const frame::Texture>(std::move(made));
}

constexpr std::array<std::uint8_t, 4> kRedPixel{180, 20, 20, 255}, kGreenPixel{20, 180, 20, 255},
    kBluePixel{20, 20, 180, 255}, kWhitePixel{180, 180, 180, 255}, kHolePixel{180, 20, 20, 0};

/// A square of 0.5 m, seen and lit from the front, which fills 0.687 of the picture's width. u [m] points right, v [m]
/// up.
frame::FrameSnapshot painted_square(frame::ObjectKind kind, std::shared_ptr<const frame::Texture> picture,
                                    Alpha alpha) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  frame::Surface& surface = add_square(snapshot, kind, Vec3::Zero(), -Vec3::UnitY(), Vec3::UnitX(), 0.25);
  surface.uv = {{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
  surface.appearance.color = alpha == Alpha::over_color ? Vec3(0.1, 0.1, 0.6) : Vec3(1, 1, 1);
  surface.appearance.paint.texture = std::move(picture);
  surface.appearance.paint.texture_from_uv << 2, 0, 0, 0, 2, 0;
  surface.appearance.paint.alpha = alpha;
  snapshot.cameras = {camera_at(Vec3(0, -1, 0), Vec3::Zero(), 40)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

/// Whether the picture has about this colour at a place, given as fractions of the picture from the left and the top.
/// `tolerance`: levels of 255.
testing::AssertionResult shows(const image::Image& image, double x, double y, const std::array<std::uint8_t, 4>& color,
                               double tolerance = 6) {
  const std::uint8_t* pixel = image.pixel(static_cast<int>(x * kPaintedSide), static_cast<int>(y * kPaintedSide));
  for (int channel = 0; channel < 3; ++channel)
    if (std::abs(pixel[channel] - color[channel]) > tolerance)
      return testing::AssertionFailure() << int(pixel[0]) << " " << int(pixel[1]) << " " << int(pixel[2]);
  return testing::AssertionSuccess();
}

// In frontal light of full strength, a surface shows its own colour
// (Picture.MatteSurfaceFacingTheLightShowsItsOwnColor).
TEST(Paint, LiesWithItsTopUpwardAndItsLeftToTheLeft) {
  for (const auto kind : {frame::ObjectKind::cloth, frame::ObjectKind::character}) {
    const auto snapshot =
        painted_square(kind, texture(2, 2, {kRedPixel, kGreenPixel, kBluePixel, kWhitePixel}), Alpha::ignored);
    const image::Image image = Renderer(painted_settings()).draw(snapshot);
    EXPECT_TRUE(shows(image, 0.33, 0.33, kRedPixel));
    EXPECT_TRUE(shows(image, 0.67, 0.33, kGreenPixel));
    EXPECT_TRUE(shows(image, 0.33, 0.67, kBluePixel));
    EXPECT_TRUE(shows(image, 0.67, 0.67, kWhitePixel));
  }
}

TEST(Paint, RepeatsInMetresOrLiesOnceOnItsColor) {
  auto snapshot = painted_square(frame::ObjectKind::cloth, texture(1, 2, {kRedPixel, kGreenPixel}), Alpha::over_color);
  auto& paint = const_cast<frame::Surface&>(*snapshot.surfaces[0]).appearance.paint;
  paint.texture_from_uv << 4, 0, 0, 0, 4, 0;  // tiles of 0.25 m with two stripes
  const image::Image tiled = Renderer(painted_settings()).draw(snapshot);
  const auto height = [](double v) {
    return 0.5 - 0.687 * (v - 0.5);
  };  // fraction of the picture from the top, for a fraction of the square from below
  EXPECT_TRUE(shows(tiled, 0.5, height(0.125), kGreenPixel));
  EXPECT_TRUE(shows(tiled, 0.5, height(0.375), kRedPixel));
  EXPECT_TRUE(shows(tiled, 0.5, height(0.625), kGreenPixel));
  EXPECT_TRUE(shows(tiled, 0.5, height(0.875), kRedPixel));
  paint.wrap_u = paint.wrap_v = frame::Paint::Wrap::once;
  const image::Image once = Renderer(painted_settings()).draw(snapshot);
  EXPECT_TRUE(shows(once, 0.32, height(0.375), kRedPixel));
  EXPECT_TRUE(shows(once, 0.5, height(0.875), {26, 26, 153, 255}));
}

TEST(Paint, HolesShowWhatIsBehindThemInDrawingAndInShadow) {
  for (const Quality quality : {Quality::draft, Quality::final}) {
    auto snapshot = painted_square(frame::ObjectKind::cloth, texture(2, 1, {kHolePixel, kRedPixel}), Alpha::cutout);
    // A wall 0.5 m behind the cloth.
    add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0.5, 0), -Vec3::UnitY(), Vec3::UnitX(), 2)
        .appearance.color = Vec3(0.7, 0.7, 0.7);
    const image::Image image = Renderer(painted_settings(quality)).draw(snapshot);
    EXPECT_TRUE(shows(image, 0.67, 0.5, kRedPixel));
    EXPECT_TRUE(shows(image, 0.3, 0.5, kWhitePixel)) << "the wall, lit through the hole";
    // A camera at the side sees the wall beside the cloth. Only the right half of the cloth casts a shadow.
    snapshot.cameras = {camera_at(Vec3(1.2, -1, 0), Vec3(0, 0.5, 0), 40)};
    const frame::Camera& camera = snapshot.cameras[0];
    const Vec3 forward = (camera.target - camera.position).normalized(), right = forward.cross(Vec3::UnitZ());
    // Fraction of the picture from the left, for the place x [m] on the wall.
    const auto across = [&](double x) {
      const Vec3 to = Vec3(x, 0.5, 0) - camera.position;
      return 0.5 + 0.5 * right.dot(to) / (forward.dot(to) * std::tan(20 * 3.14159265 / 180));
    };
    const image::Image aside = Renderer(painted_settings(quality)).draw(snapshot);
    EXPECT_TRUE(shows(aside, across(0.4), 0.5, kWhitePixel, 40)) << "beside the square";
    EXPECT_LT(aside.pixel(static_cast<int>(across(0.12) * kPaintedSide), kPaintedSide / 2)[1], 90)
        << "behind its threads";
  }
}

TEST(Paint, AroundASingleTileIsAHoleIfThePictureCutsHoles) {
  for (const Quality quality : {Quality::draft, Quality::final}) {
    auto snapshot = painted_square(frame::ObjectKind::cloth, texture(1, 1, {kRedPixel}), Alpha::cutout);
    auto& paint = const_cast<frame::Surface&>(*snapshot.surfaces[0]).appearance.paint;
    paint.texture_from_uv << 4, 0, 0, 0, 4, 0;  // the tile is the lower left quarter
    paint.wrap_u = paint.wrap_v = frame::Paint::Wrap::once;
    add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 3, 0), -Vec3::UnitY(), Vec3::UnitX(), 4)
        .appearance.color = Vec3(0.7, 0.7, 0.7);
    const image::Image image = Renderer(painted_settings(quality)).draw(snapshot);
    EXPECT_TRUE(shows(image, 0.33, 0.67, kRedPixel));
    EXPECT_LT(image.pixel(kPaintedSide * 2 / 3, kPaintedSide / 3)[0],
              image.pixel(kPaintedSide * 2 / 3, kPaintedSide / 3)[1] + 30)
        << "the grey wall";
  }
}

TEST(Paint, HalfTransparentClothIsHalfSeenFromAfar) {
  const std::array<std::uint8_t, 4> veil{180, 20, 20, 128};
  auto snapshot = painted_square(frame::ObjectKind::cloth, texture(1, 1, {veil}), Alpha::cutout);
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 3, 0), -Vec3::UnitY(), Vec3::UnitX(), 4).appearance.color =
      Vec3(0.7, 0.7, 0.7);
  const image::Image image = Renderer(painted_settings()).draw(snapshot);
  double red = 0, green = 0;
  int count = 0;
  for (int y = 60; y < 100; ++y) {
    for (int x = 60; x < 100; ++x, ++count) {
      red += image.pixel(x, y)[0];
      green += image.pixel(x, y)[1];
    }
  }
  // Half of the samples show the grey wall, the others the veil, whose red exceeds its green by 160 levels: 80 on
  // average. Tolerance: there are only sixteen samples and thresholds.
  EXPECT_NEAR((red - green) / count, 80, 12);
}

TEST(Paint, HalfASizeKeepsTheMeanOfLightAtAnySize) {
  frame::Texture checks{7, 5, {}};
  double mean = 0;
  for (int i = 0; i < 35; ++i) {
    const auto level = static_cast<std::uint8_t>(37 * i % 256);
    checks.rgba.insert(checks.rgba.end(), {level, level, level, 255});
    mean += image::linear_from_srgb(level / 255.0) / 35;
  }
  MipLevel level = base_mip_level(checks, false);
  while (level.width > 1 || level.height > 1) level = next_mip_level(level);
  EXPECT_NEAR(level.texels[0].x(), mean, 1e-5);
  EXPECT_NEAR(level.texels[0].w(), 1, 1e-5);
}

TEST(Paint, WhatIsTransparentGivesNoColorToWhatIsNot) {
  const MipLevel half = next_mip_level(base_mip_level(*texture(2, 1, {{0, 255, 0, 0}, {255, 0, 0, 255}}, 1), false));
  EXPECT_NEAR(half.texels[0].w(), 0.5, 1e-6);
  EXPECT_NEAR(half.texels[0].x(), 0.5, 1e-6);
  EXPECT_NEAR(half.texels[0].y(), 0, 1e-6);
}

// Prints are pictures over the colour of the cloth. Here, they cover half of it; the other half is transparent.
TEST(Paint, PrintsReflectLightInTheirColor) {
  frame::Appearance look;
  look.color = Vec3(0, 0, 1);
  look.paint.texture = texture(2, 1, {{255, 0, 0, 255}, {0, 255, 0, 0}}, 1);
  look.paint.alpha = Alpha::over_color;
  MeanColors colors;
  EXPECT_TRUE(colors.of(look, false).isApprox(Eigen::Vector3f(0.5f, 0, 0.5f)));
  EXPECT_TRUE(colors.of(look, true).isApprox(Eigen::Vector3f(0.5f, 0, 0.5f)));
  look.back_paleness = 0.2;
  const float pale = std::pow(0.8f * std::sqrt(0.5f) + 0.2f, 2.0f);
  EXPECT_TRUE(colors.of(look, true).isApprox(Eigen::Vector3f(pale, 0.04f, pale)));
  look.back_painted = false;
  look.back_color = Vec3(0, 1, 0);
  EXPECT_TRUE(colors.of(look, true).isApprox(Eigen::Vector3f(0, 1, 0)));
}

TEST(Paint, VerticesAreSplitWhereCornersLieElsewhereAndTrianglesSortedByPart) {
  frame::Surface surface;
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  surface.parts.resize(2);
  surface.part_of_triangle = {1, 0, 1};
  surface.paint_uv = {
      {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(5, 0), Vec2(6, 1), Vec2(5, 1)}, {Vec2(1, 0), Vec2(2, 0), Vec2(1, 1)}};
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
  ShadedMesh mesh = make_shaded_mesh(surface.triangles, CornerMap(surface.triangles, 5), positions, 180);
  const PaintedMesh painted = make_painted_mesh(surface, mesh);
  ASSERT_EQ(painted.ranges.size(), 2u);
  EXPECT_EQ(painted.ranges[0].look, &surface.parts[0].appearance);
  EXPECT_EQ(painted.ranges[0].count, 1u);
  EXPECT_EQ(painted.ranges[1].count, 2u);
  EXPECT_EQ(mesh.source.size(), 7u) << "two vertices of the seam lie twice";
  const std::size_t order[] = {1, 0, 2};
  for (std::size_t t = 0; t < 3; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index drawn = mesh.triangles[t][k];
      EXPECT_EQ(mesh.source[static_cast<std::size_t>(drawn)], surface.triangles[order[t]][k]);
      EXPECT_EQ(painted.places[static_cast<std::size_t>(drawn)].cast<double>(), surface.paint_uv[order[t]][k]);
    }
  }
}

}  // namespace
}  // namespace weft::render
