// Each stage of FLIP against what its formula gives on paper.
#include "compare/flip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compare/pictures.hpp"

namespace weft::compare {
namespace {

using flip::Color;

TEST(Flip, WhiteAndGraysHaveNoColourInTheOpponentSpace) {
  for (const float gray : {0.0f, 0.2f, 1.0f}) {
    const Color opponent = flip::opponent_from_linear({gray, gray, gray});
    EXPECT_NEAR(opponent[0], 116 * gray - 16, 1e-4);
    EXPECT_NEAR(opponent[1], 0, 1e-4);
    EXPECT_NEAR(opponent[2], 0, 1e-4);
  }
}

TEST(Flip, OpponentSpaceInverts) {
  for (const Color& color : {Color(1, 0, 0), Color(0.1f, 0.7f, 0.3f), Color(0, 0, 1)}) {
    EXPECT_LT((flip::linear_from_opponent(flip::opponent_from_linear(color)) - color).norm(), 1e-6);
  }
}

// L*a*b* of the primaries of sRGB as tables print them, a* and b* times L*/100. 0.02: their last digit, times 1.
TEST(Flip, PrimariesHaveTheirLabShrunkByLightness) {
  const auto expect = [](const Color& linear, double lightness, double a, double b) {
    const Color lab = flip::hunt_lab(linear);
    EXPECT_NEAR(lab[0], lightness, 0.02);
    EXPECT_NEAR(lab[1], a * lightness / 100, 0.02);
    EXPECT_NEAR(lab[2], b * lightness / 100, 0.02);
  };
  expect({1, 0, 0}, 53.24, 80.09, 67.20);
  expect({0, 1, 0}, 87.73, -86.18, 83.18);
  expect({0, 0, 1}, 32.30, 79.19, -107.86);
  expect({1, 1, 1}, 100, 0, 0);
}

TEST(Flip, DistanceAddsLightnessAndChroma) {
  EXPECT_FLOAT_EQ(flip::hyab({50, 3, 0}, {40, 0, 4}), 10 + 5);
}

// The curve is two straight lines over distance^0.7; green to blue is the far end.
TEST(Flip, RemappedDistancesMeetTheirThreePoints) {
  const float largest = flip::hyab(flip::hunt_lab({0, 1, 0}), flip::hunt_lab({0, 0, 1}));
  EXPECT_NEAR(flip::remapped(0), 0, 1e-6);
  EXPECT_NEAR(flip::remapped(largest * std::pow(0.4f, 1 / 0.7f)), 0.95, 1e-5);
  EXPECT_NEAR(flip::remapped(largest * std::pow(0.7f, 1 / 0.7f)), 0.975, 1e-5);
  EXPECT_NEAR(flip::remapped(largest), 1, 1e-6);
}

// Mean over the middle of a plane with one grating, divided by its amplitude.
double gain(int channel, double cycles_per_degree) {
  const auto wave = [&](int x) { return std::cos(2 * std::numbers::pi * cycles_per_degree * x / kPixelsPerDegree); };
  Plane<float> plane(401, 9);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) plane.row(y)[x] = static_cast<float>(wave(x - 200));
  }
  return static_cast<double>(flip::as_seen(plane, channel).row(4)[200]);
}

// What the Gaussians of Table 1 do to a grating, continuous: exp(-b f²), and for two of them the mean weighted with
// a sqrt(b). 0.01: kernels end at three sigmas of the widest, which leaves out 0.3 %, and are sampled at pixels.
TEST(Flip, GratingsAreDampedByTheContrastSensitivity) {
  for (const double f : {0.5, 2.0, 5.0, 10.0, 20.0}) {
    EXPECT_NEAR(gain(0, f), std::exp(-0.0047 * f * f), 0.01) << f;
    EXPECT_NEAR(gain(1, f), std::exp(-0.0053 * f * f), 0.01) << f;
    const double first = 34.1 * std::sqrt(0.04), second = 13.5 * std::sqrt(0.025);
    const double both = (first * std::exp(-0.04 * f * f) + second * std::exp(-0.025 * f * f)) / (first + second);
    EXPECT_NEAR(gain(2, f), both, 0.01) << f;
  }
}

TEST(Flip, FlatPlanesPassTheFilterUnchanged) {
  Plane<float> plane(30, 20);
  std::fill(plane.values.begin(), plane.values.end(), 7.5f);
  for (int channel = 0; channel < 3; ++channel) {
    for (const float value : flip::as_seen(plane, channel).values) ASSERT_NEAR(value, 7.5, 1e-4);
  }
}

// The positive half of the edge filter adds up to 1 and lies on one side, so beside a step from 0 to 1 it answers 1,
// and the difference to nothing is (1/sqrt 2)^(1/2).
TEST(Flip, StepAgainstNothingIsTheLargestFeatureOfOneDirection) {
  Plane<float> step(81, 41), nothing(81, 41);
  for (int y = 0; y < step.height; ++y) {
    for (int x = 41; x < step.width; ++x) step.row(y)[x] = 1;
  }
  const Plane<float> difference = flip::feature_difference(nothing, step);
  EXPECT_NEAR(difference.row(20)[40], std::pow(2.0, -0.25), 1e-4);
  EXPECT_NEAR(*std::max_element(difference.values.begin(), difference.values.end()), std::pow(2.0, -0.25), 1e-4);
  EXPECT_NEAR(difference.row(20)[5], 0, 1e-3);
}

// Without edges the map is the remapped distance. Black to white: HyAB 100, and 100^0.7 = 25.12 lies past the bend.
TEST(Flip, BlackAgainstWhiteIsTheDistanceOfItsColours) {
  const Plane<float> map = flip_map(plain(40, 30, 0, 0, 0), plain(40, 30, 255, 255, 255));
  const double largest = std::pow(203.3, 0.7), bend = 0.4 * largest;  // green to blue, from the table above
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - bend) / (largest - bend);
  for (const float value : map.values) ASSERT_NEAR(value, expected, 1e-4);
}

TEST(Flip, EqualImagesLookTheSame) {
  const image::Image image = textured(64, 48, 1);
  for (const float value : flip_map(image, image).values) ASSERT_EQ(value, 0);
}

TEST(Flip, ExchangingTheImagesChangesNothing) {
  const image::Image a = textured(64, 48, 1), b = with_noise(a, 300, 20, 5);
  EXPECT_EQ(flip_map(a, b).values, flip_map(b, a).values);
}

// Sums to 1 by construction; a small bright spot on black is blurred to less, and still stands out as a point.
TEST(Flip, SpotIsSeenWhereItIsAndNotFarFromIt) {
  const image::Image black = plain(81, 81, 0, 0, 0);
  image::Image spot = black;
  for (int y = 39; y < 42; ++y) std::fill_n(spot.pixel(39, y), 9, std::uint8_t{255});
  const Plane<float> map = flip_map(black, spot);
  EXPECT_GT(map.row(40)[40], 0.8);
  EXPECT_LT(map.row(40)[80], 1e-3);
  EXPECT_LT(map.row(0)[40], 1e-3);
}

}  // namespace
}  // namespace weft::compare
