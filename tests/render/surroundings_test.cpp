#include "render/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
  return surround(style_of(stage), stage, Vec3::UnitZ(), {&key, 1}, ground);
}

/// Light on matte white facing n, summed up over the sphere.
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

// Nine harmonics leave out a few percent of what narrow boxes give (Ramamoorthi and Hanrahan: 3 % on the mean, 9 % at
// most). The light is of order 0.4; seen are 0.025.
TEST(Surroundings, IrradianceIsTheSumOverAllDirections) {
  for (const Look look : kLooks) {
    const Surroundings around = surroundings_of(look, Vec3(0.3, 0.2, 0.1));
    const Irradiance irradiance = irradiance_of(around);
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.6, 0, 0.8),
                          Vec3(-0.48, 0.6, 0.64), Vec3(0.36, 0.48, -0.8)})
      EXPECT_LT((at(irradiance, n) - summed(around, n)).cwiseAbs().maxCoeff(), 0.04)
          << static_cast<int>(look) << " " << n.transpose() << ": " << at(irradiance, n).transpose() << " and "
          << summed(around, n).transpose();
  }
}

// Sums over 24 rows of cells: ground of 0.5, which what faces the sky does not see, adds 0.0015.
TEST(Surroundings, WhatLiesFlatGetsTheShareOfTheStyle) {
  for (const Look look : kLooks) {
    for (const double ground : {0.0, 0.5}) {
      frame::Stage stage;
      stage.look = look;
      stage.sky_color = Vec3(0.9, 0.8, 1.0);
      const Style style = style_of(stage);
      const Vec3 flat = at(irradiance_of(surroundings_of(look, Vec3::Constant(ground))), Vec3::UnitZ());
      EXPECT_LT((flat - style.sky_intensity * style.sky_color).cwiseAbs().maxCoeff(), 2e-3)
          << static_cast<int>(look) << ": " << flat.transpose();
    }
  }
}

// A mirror sees the middle of a box as bright as it is, a rough surface sees it weaker and wider; all of it stays.
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
  // A Gaussian of sharpness s holds 2 pi / s (1 - exp(-2 s)); that of the widest has s = 2.4.
  EXPECT_NEAR(whole(0.05), 2 / (2 * 40.0), 1e-3);
  EXPECT_NEAR(whole(0.9), 2 / (2 * 40.0), 1e-3);
  EXPECT_LT(around.light(Vec3(0.6, 0, 0.8), 0.9).x(), 0.5);
}

}  // namespace
}  // namespace weft::render
