#include "film/image/color.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::image {
namespace {

// IEC 61966-2-1, computed by hand: 0.5 encoded is ((0.5 + 0.055) / 1.055)^2.4 linear.
TEST(Color, SrgbCurveMeetsItsStandardAndInverts) {
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114048223255, 1e-15);
  EXPECT_NEAR(linear_from_srgb(0.04), 0.04 / 12.92, 1e-15);
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0)), i / 255.0, 1e-7);
}

double lightness(const Vec3& linear) {
  const double y = 0.2126 * linear.x() + 0.7152 * linear.y() + 0.0722 * linear.z();
  return y > std::pow(6.0 / 29, 3) ? 116 * std::cbrt(y) - 16 : y * 903.3;
}

// Tolerance 0.05, since the luminance weights above have four digits, and the matrix of the program seven.
TEST(Color, HeatLightnessRisesEvenlyFrom15To90) {
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(lightness(heat_color(i / 20.0)), 15 + 75 * i / 20.0, 0.05) << i;
}

TEST(Color, HeatOutsideTheScaleKeepsTheEnds) {
  EXPECT_EQ(heat_color(-1), heat_color(0));
  EXPECT_EQ(heat_color(7), heat_color(1));
  EXPECT_EQ(heat_table().front(), heat_color(0));
  EXPECT_EQ(heat_table().back(), heat_color(1));
}

}  // namespace
}  // namespace weft::image
