// Compares each stage of FLIP with its formula, computed by hand.
#include "tools/compare/flip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

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

// L*a*b* of the sRGB primaries from published tables; a* and b* are multiplied by L*/100. Tolerance 0.02, since the
// tables have two decimals.
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

// The curve consists of two straight lines over distance^0.7. Green and blue have the largest distance.
TEST(Flip, RemappedDistancesMeetTheirThreePoints) {
  const float largest = flip::hyab(flip::hunt_lab({0, 1, 0}), flip::hunt_lab({0, 0, 1}));
  EXPECT_NEAR(flip::remap_distance(0), 0, 1e-6);
  EXPECT_NEAR(flip::remap_distance(largest * std::pow(0.4f, 1 / 0.7f)), 0.95, 1e-5);
  EXPECT_NEAR(flip::remap_distance(largest * std::pow(0.7f, 1 / 0.7f)), 0.975, 1e-5);
  EXPECT_NEAR(flip::remap_distance(largest), 1, 1e-6);
}

// Value of the filtered channel in the middle of a plane with a grating of amplitude 1.
double gain(int channel, double cycles_per_degree) {
  const auto wave = [&](int x) { return std::cos(2 * std::numbers::pi * cycles_per_degree * x / kPixelsPerDegree); };
  Plane<float> plane(401, 9);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) plane.row(y)[x] = static_cast<float>(wave(x - 200));
  }
  return static_cast<double>(flip::filter_by_contrast_sensitivity(plane, channel).row(4)[200]);
}

// Without discretisation, a channel with one Gaussian of Table 1 of the paper multiplies a grating by exp(-b f²). A
// channel with two Gaussians multiplies it by the weighted mean of their factors; the weights are the products of the
// table's a and sqrt(b). Tolerance 0.01: kernels are sampled at pixels and end at three sigmas of the
// widest Gaussian, which omits 0.3 %.
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
    for (const float value : flip::filter_by_contrast_sensitivity(plane, channel).values) ASSERT_NEAR(value, 7.5, 1e-4);
  }
}

// The positive weights of the edge filter sum to 1 and all lie on one side of its centre. So its response to a step
// from 0 to 1 is 1, and the difference from an empty plane is (1/sqrt 2)^(1/2).
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

// Without edges, the map is the remapped distance. Black and white have the HyAB distance 100; 100^0.7 = 25.12 is
// beyond the point `bend`, where the two lines of the curve meet. 203.3 is the HyAB distance of green and blue,
// computed from the L*a*b* values in the test of the primaries.
TEST(Flip, BlackAgainstWhiteIsTheDistanceOfItsColours) {
  const Plane<float> map = flip_map(plain(40, 30, 0, 0, 0), plain(40, 30, 255, 255, 255));
  const double largest = std::pow(203.3, 0.7), bend = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - bend) / (largest - bend);
  for (const float value : map.values) ASSERT_NEAR(value, expected, 1e-4);
}

// A second implementation of the two filters, directly from the formulas of the paper: with two-dimensional kernels, in
// double precision, pixel by pixel. All constants are repeated here.
namespace paper {

constexpr double kPi = std::numbers::pi;
using Map = std::vector<double>;

struct Picture {
  int width, height;
  double at(const Map& map, int x, int y) const {
    return map[std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1)];
  }
  /// Convolution with a kernel whose positive values are scaled to the sum 1, and negative values, if any, to the sum
  /// -1.
  template <class Kernel>
  Map filtered(const Map& map, int radius, const Kernel& kernel) const {
    double positive = 0, negative = 0;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) (kernel(dx, dy) > 0 ? positive : negative) += std::abs(kernel(dx, dy));
    Map out(map.size());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int dy = -radius; dy <= radius; ++dy)
          for (int dx = -radius; dx <= radius; ++dx) {
            const double value = kernel(dx, dy);
            out[y * width + x] += value / (value > 0 ? positive : negative) * at(map, x - dx, y - dy);
          }
    return out;
  }
};

// The contrast filter, as Table 1 and Section 4.1.1 state it. The radius is three standard deviations of the widest
// Gaussian, exp(-pi^2 x^2 / 0.04).
Map as_seen(const Picture& picture, const Map& map, int channel) {
  struct {
    double a1, b1, a2, b2;
  } const table[] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
  const auto& [a1, b1, a2, b2] = table[channel];
  const auto kernel = [&, a1 = a1, b1 = b1, a2 = a2, b2 = b2](int dx, int dy) {
    const double x_sq = (dx * dx + dy * dy) / (kPixelsPerDegree * kPixelsPerDegree);
    return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * x_sq / b1) +
           a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * x_sq / b2);
  };
  return picture.filtered(map, static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * kPixelsPerDegree)),
                          kernel);
}

// The feature difference, as Section 4.2 states it: (|dF| / sqrt 2)^(1/2), where dF is the difference in edges or in
// points, whichever is larger. The standard deviation is half of 0.082 degrees.
Map feature_difference(const Picture& picture, const Map& a, const Map& b) {
  const double sigma = 0.5 * 0.082 * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto g = [&](int dx, int dy) { return std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma)); };
  const auto strength = [&](const Map& map, const auto& derivative) {
    Map dx = picture.filtered(map, radius, [&](int x, int y) { return derivative(x) * g(x, y); });
    const Map dy = picture.filtered(map, radius, [&](int x, int y) { return derivative(y) * g(x, y); });
    for (std::size_t i = 0; i < dx.size(); ++i) dx[i] = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
    return dx;
  };
  const auto edge = [](int x) { return -static_cast<double>(x); };
  const auto point = [&](int x) { return x * x / (sigma * sigma) - 1; };
  const Map edges_a = strength(a, edge), edges_b = strength(b, edge);
  const Map points_a = strength(a, point), points_b = strength(b, point);
  Map difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    difference[i] =
        std::sqrt(std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i])) / std::sqrt(2.0));
  return difference;
}

}  // namespace paper

// Tolerance 1e-3: ten times the expected error of float sums of a thousand terms under a square root (not measured). A
// kernel constant that is wrong by 10 % changes values by more.
TEST(Flip, FeaturesAreThoseOfThePapersKernels) {
  const paper::Picture size{40, 32};
  Plane<float> planes[] = {{size.width, size.height}, {size.width, size.height}};
  Noise noise(7);
  // Six random blocks per plane, 1 to 9 pixels wide and 1 to 7 high. Each row of a block has its own value from 0 to 1.
  for (Plane<float>& plane : planes) {
    std::fill(plane.values.begin(), plane.values.end(), 0.2f);
    for (int block = 0; block < 6; ++block) {
      const int left = noise.below(30), top = noise.below(24), wide = 1 + noise.below(9), high = 1 + noise.below(7);
      for (int y = top; y < top + high; ++y) std::fill_n(plane.row(y) + left, wide, 0.1f * noise.below(11));
    }
  }
  const auto map = [](const Plane<float>& plane) { return paper::Map(plane.values.begin(), plane.values.end()); };
  const paper::Map expected = paper::feature_difference(size, map(planes[0]), map(planes[1]));
  const Plane<float> found = flip::feature_difference(planes[0], planes[1]);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found.values[i], expected[i], 1e-3) << i;
}

TEST(Flip, ChannelsAreSeenThroughThePapersKernels) {
  const paper::Picture size{40, 32};
  Plane<float> plane(size.width, size.height);
  Noise noise(8);
  for (float& value : plane.values) value = static_cast<float>(noise.below(101));
  for (int channel = 0; channel < 3; ++channel) {
    const paper::Map expected = paper::as_seen(size, paper::Map(plane.values.begin(), plane.values.end()), channel);
    const Plane<float> found = flip::filter_by_contrast_sensitivity(plane, channel);
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found.values[i], expected[i], 1e-3) << i;
  }
}

TEST(Flip, EqualImagesLookTheSame) {
  const image::Image image = textured(64, 48, 1);
  for (const float value : flip_map(image, image).values) ASSERT_EQ(value, 0);
}

TEST(Flip, ExchangingTheImagesChangesNothing) {
  const image::Image a = textured(64, 48, 1), b = with_noise(a, 300, 20, 5);
  EXPECT_EQ(flip_map(a, b).values, flip_map(b, a).values);
}

// The contrast filter sums to 1, so it only blurs a small bright spot. The spot still counts as a point feature.
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
