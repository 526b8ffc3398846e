#include "film/render/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/image/color.hpp"
#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

using Look = frame::Stage::Look;
constexpr Look kLooks[] = {Look::studio, Look::stage, Look::daylight, Look::clay, Look::wire, Look::strain};

Surroundings surroundings_of(Look look, const Vec3& ground) {
  frame::Stage stage;
  stage.look = look;
  stage.sky_color = Vec3(0.9, 0.8, 1.0);
  frame::Light key;
  key.direction = Vec3(-0.4, -0.5, -1);
  return make_surroundings(style_of(stage), stage, Vec3::UnitZ(), {&key, 1}, ground);
}

/// Light that a matte white surface with normal n receives, summed over the sphere.
Vec3 summed(const Surroundings& around, const Vec3& n) {
  constexpr int kRows = 180, kColumns = 360;
  Vec3 sum = Vec3::Zero();
  for (int row = 0; row < kRows; ++row) {
    const double z = -1 + (row + 0.5) * 2 / kRows, r = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double angle = (column + 0.5) * 2 * std::numbers::pi / kColumns;
      const Vec3 toward(r * std::cos(angle), r * std::sin(angle), z);
      sum += std::max(0.0, toward.dot(n)) * around.light(toward, 0.1) * (4 / (1.0 * kRows * kColumns));
    }
  }
  return sum;
}

// Nine spherical harmonics miss a part of the light of narrow boxes (Ramamoorthi and Hanrahan: 3 % on average, at most
// 9 %). The light is about 0.4; the measured error is 0.025.
TEST(Surroundings, IrradianceIsTheSumOverAllDirections) {
  for (const Look look : kLooks) {
    const Surroundings around = surroundings_of(look, Vec3(0.3, 0.2, 0.1));
    const Irradiance irradiance = irradiance_of(around);
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.6, 0, 0.8),
                          Vec3(-0.48, 0.6, 0.64), Vec3(0.36, 0.48, -0.8)})
      EXPECT_LT((evaluate_irradiance(irradiance, n) - summed(around, n)).cwiseAbs().maxCoeff(), 0.04)
          << static_cast<int>(look) << " " << n.transpose() << ": " << evaluate_irradiance(irradiance, n).transpose()
          << " and " << summed(around, n).transpose();
  }
}

// A horizontal surface receives the light of the style's sky, and none from the ground. Tolerance: irradiance_of() sums
// over 24 rows of cells. By this error, a ground of 0.5 adds 0.0015.
TEST(Surroundings, WhatLiesFlatGetsTheShareOfTheStyle) {
  for (const Look look : kLooks) {
    for (const double ground : {0.0, 0.5}) {
      frame::Stage stage;
      stage.look = look;
      stage.sky_color = Vec3(0.9, 0.8, 1.0);
      const Style style = style_of(stage);
      const Vec3 flat =
          evaluate_irradiance(irradiance_of(surroundings_of(look, Vec3::Constant(ground))), Vec3::UnitZ());
      EXPECT_LT((flat - style.sky_intensity * style.sky_color).cwiseAbs().maxCoeff(), 2e-3)
          << static_cast<int>(look) << ": " << flat.transpose();
    }
  }
}

/// Green levels along the left border of a picture with a sheet at this height [m]. The sheet neither covers the border
/// nor casts a shadow on it.
std::vector<int> left_border(double height) {
  frame::FrameSnapshot snapshot;
  add_floor(snapshot);
  add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0, height), Vec3::UnitZ(), Vec3::UnitX(), 0.5).run_bounds =
      Box3(Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 2));
  snapshot.cameras = {camera_at(Vec3(0, -8, 1.5), Vec3(0, 0, 0.8), 40)};
  // Open floor is interpolated over 16 pixels, too coarse for smaller pictures.
  const image::Image image = drawn(snapshot, 4);
  std::vector<int> bytes;
  for (int y = 0; y < image.height; ++y) bytes.push_back(image.pixel(0, y)[1]);
  return bytes;
}

TEST(Surroundings, AreThoseOfTheRunWhileASheetFalls) {
  const std::vector<int> high = left_border(2), low = left_border(0.2);
  // The sheet is farther from the left border than it is wide, so it hides less than 1/255 of the sky there.
  for (std::size_t y = 0; y < high.size(); ++y) EXPECT_NEAR(high[y], low[y], 1) << y;
}

// A mirror shows the middle of a box with its own brightness; a rough surface shows it dimmer and wider, with the same
// sum of light.
TEST(Surroundings, BlurKeepsTheLightOfABox) {
  Surroundings around;
  around.boxes[0] = {Vec3(0.6, 0, 0.8), 40, Vec3(2, 1, 0.5)};
  EXPECT_NEAR(around.light(Vec3(0.6, 0, 0.8), 0.01).x(), 2, 0.01);
  const auto whole = [&](double alpha) {
    double sum = 0;
    constexpr int kRows = 400, kColumns = 400;
    for (int row = 0; row < kRows; ++row) {
      const double z = -1 + (row + 0.5) * 2 / kRows, r = std::sqrt(1 - z * z);
      for (int column = 0; column < kColumns; ++column) {
        const double angle = (column + 0.5) * 2 * std::numbers::pi / kColumns;
        sum += around.light(Vec3(r * std::cos(angle), r * std::sin(angle), z), alpha).x();
      }
    }
    return sum / (kRows * kColumns);
  };
  // The mean of a Gaussian of sharpness s over the sphere is (1 - exp(-2 s)) / (2 s). Blurring keeps that of the box,
  // with s = 40. Tolerance: for alpha 0.9, s is 2.3 and exp(-2 s) 0.01.
  EXPECT_NEAR(whole(0.05), 2 / (2 * 40.0), 1e-3);
  EXPECT_NEAR(whole(0.9), 2 / (2 * 40.0), 1e-3);
  EXPECT_LT(around.light(Vec3(0.6, 0, 0.8), 0.9).x(), 0.5);
}

/// White floor in front of a wall 0.6 m wide and high with its lower edge at `height` [m]. `shelf`: replaces a white
/// sheet on the floor by a black one 0.3 m above the floor. Horizontal light from the front lights only the wall.
image::Image wall(double height, bool shelf) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_floor(snapshot).appearance.color = Vec3::Ones();
  const auto add = [&](const Vec3& center, const Vec3& normal, const Vec3& color) {
    auto& look = add_square(snapshot, frame::ObjectKind::cloth, center, normal, Vec3::UnitX(), 0.3).appearance;
    look.color = look.back_color = color;
    // No fuzz: at this angle, protruding fibres would reflect 25 % more light.
    look.finish = {0, 0.5, 0, 0};
  };
  add(Vec3(0, 0, height + 0.3), -Vec3::UnitY(), Vec3(0.9, 0.3, 0.3));
  add(Vec3(0, -0.32, shelf ? 0.3 : 5e-4), Vec3::UnitZ(), shelf ? Vec3::Zero() : Vec3::Ones());
  snapshot.cameras = {camera_at(Vec3(0, -2.4, 0.22), Vec3(0, -0.3, 0), 10)};
  snapshot.lights = {sun(Vec3(0, 1, 0))};
  return drawn(snapshot, 1);
}

/// Light in the middle of the picture, which shows the floor 0.3 m in front of the wall; mean over 14 cm along the
/// wall.
Vec3 light_on_floor(const image::Image& image) {
  Vec3 sum = Vec3::Zero();
  for (int x = 60; x < 100; ++x) {
    const std::uint8_t* pixel = image.pixel(x, 50);
    sum += image::linear_from_srgb(Vec3(pixel[0], pixel[1], pixel[2]) / 255);
  }
  return sum / 40;
}

// Floor without direct light receives light that a lit wall reflects. Expected: the form factor of the wall, times the
// light on the wall, which the program increases to its limit of 1.8, because the floor is dark. Tolerance 10 %: noise
// of some hundred points with four rays each. A shelf between wall and floor must block more than two thirds of the
// light.
TEST(BouncedLight, ALitWallColorsTheFloorBeforeItUnlessSomethingIsBetween) {
  for (const double height : {0.0, 0.4}) {
    double factor = 0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double x = (i + 0.5) * 0.6 / kSteps - 0.3, z = (j + 0.5) * 0.6 / kSteps + height,
                     d_sq = x * x + z * z + 0.3 * 0.3;
        factor += 0.3 * z / (std::numbers::pi * d_sq * d_sq) * 0.36 / (kSteps * kSteps);
      }
    }
    const Vec3 light = light_on_floor(wall(height, false)),
               expected = 1.8 * factor * image::linear_from_srgb(Vec3(0.9, 0.3, 0.3));
    EXPECT_NEAR(light.x() / expected.x(), 1, 0.1) << height;
    EXPECT_NEAR(light.y() / expected.y(), 1, 0.1) << height;
    if (height == 0) continue;
    EXPECT_LT(light_on_floor(wall(height, true)).x(), light.x() / 3);
  }
}

TEST(Floor, IsSeenHoweverItsHeightIsRounded) {
  Settings settings;
  settings.width = settings.height = 16;
  Renderer renderer(settings);
  for (int i = 0; i < 40; ++i) {
    frame::FrameSnapshot snapshot;
    frame::Surface& floor =
        add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0, -0.1 - 0.07 * i), Vec3::UnitZ(), Vec3::UnitX(), 5);
    floor.infinite_floor = true;
    floor.appearance.color = Vec3(0.1, 0.8, 0.1);
    snapshot.cameras = {camera_at(Vec3(0, -2, 1.3 + 0.013 * i), Vec3::Zero(), 30)};
    snapshot.lights = {sun(-Vec3::UnitZ())};
    const image::Image image = renderer.draw(snapshot);
    EXPECT_GT(image.pixel(8, 15)[1], 195) << i;  // 0.8 of 255 is 204; the backdrop has at most 178
  }
}

/// Light in the middle of a picture of grey floor. A lamp behind this place shines on it toward the viewer, at 50
/// degrees from the vertical.
double floor_before_a_lamp(double roughness, Quality quality) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  frame::Appearance& look = add_floor(snapshot).appearance;
  look.color = Vec3::Constant(0.5);
  look.roughness = roughness;
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(1, 0, 0.01), Vec3::UnitZ(), Vec3::UnitX(), 0.1);
  const double angle = 50 * std::numbers::pi / 180;
  snapshot.cameras = {camera_at(3 * Vec3(0, -std::sin(angle), std::cos(angle)), Vec3::Zero(), 10)};
  frame::Light lamp;
  lamp.kind = frame::Light::Kind::spot;
  lamp.position = 5 * Vec3(0, std::sin(angle), std::cos(angle));
  lamp.target = Vec3::Zero();
  snapshot.lights = {lamp};
  return light_on_floor(drawn(snapshot, 1, quality)).x();
}

// Expected: GGX facets with Smith masking (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs", 2014, Eq. 99). The program uses Hammon's shorter form, which gives 9 % less in this case.
TEST(Floor, MirrorsALampWhereItShinesMoreThanOthers) {
  const double roughness = 0.55, alpha = roughness * roughness, cosine = std::cos(50 * std::numbers::pi / 180);
  const double head_on = 0.04 * (1 - 0.9 * alpha), fresnel = head_on + (1 - head_on) * std::pow(1 - cosine, 5);
  const double hidden = (std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
  const double gloss = fresnel / (alpha * alpha) / (1 + 2 * hidden) / (4 * cosine * cosine);
  const double albedo = image::linear_from_srgb(Vec3::Constant(0.5)).x();
  for (const Quality quality : {Quality::preview, Quality::final}) {
    const double matte = floor_before_a_lamp(0.7, quality), shiny = floor_before_a_lamp(roughness, quality);
    EXPECT_NEAR((shiny / matte - 1) * albedo / gloss, 1, 0.12);
  }
}

}  // namespace
}  // namespace weft::render
