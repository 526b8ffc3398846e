#include "tools/compare/ssim.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/pictures.hpp"

namespace weft::compare {
namespace {

constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;

double luma(const std::uint8_t* p) {
  return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
}

// SSIM of one window by its definition, from squared deviations from the mean.
double window_similarity(const image::Image& a, const image::Image& b, int left, int top) {
  double total = 0, mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, cov = 0;
  const auto each = [&](const auto& body) {
    for (int j = 0; j < 11; ++j) {
      for (int i = 0; i < 11; ++i) {
        const double weight = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
        body(weight, luma(a.pixel(left + i, top + j)), luma(b.pixel(left + i, top + j)));
      }
    }
  };
  each([&](double weight, double, double) { total += weight; });
  each([&](double weight, double va, double vb) {
    mean_a += weight / total * va;
    mean_b += weight / total * vb;
  });
  each([&](double weight, double va, double vb) {
    var_a += weight / total * (va - mean_a) * (va - mean_a);
    var_b += weight / total * (vb - mean_b) * (vb - mean_b);
    cov += weight / total * (va - mean_a) * (vb - mean_b);
  });
  return (2 * mean_a * mean_b + kC1) * (2 * cov + kC2) /
         ((mean_a * mean_a + mean_b * mean_b + kC1) * (var_a + var_b + kC2));
}

double by_definition(const image::Image& a, const image::Image& b) {
  double sum = 0;
  for (int top = 0; top + 11 <= a.height; ++top) {
    for (int left = 0; left + 11 <= a.width; ++left) sum += window_similarity(a, b, left, top);
  }
  return sum / ((a.width - 10.0) * (a.height - 10.0));
}

TEST(Ssim, EqualsItsDefinition) {
  const image::Image a = textured(47, 31, 1);
  for (const image::Image& b : {with_noise(a, 500, 60, 2), textured(47, 31, 9), plain(47, 31, 90, 120, 30)}) {
    EXPECT_NEAR(structural_similarity(a, b), by_definition(a, b), 1e-10);
  }
}

TEST(Ssim, EqualImagesHaveOne) {
  const image::Image a = textured(40, 30, 3);
  EXPECT_NEAR(structural_similarity(a, a), 1, 1e-12);
}

// In flat images, all factors of Eq. (13) are 1, except the first (luminance).
TEST(Ssim, FlatImagesDifferByTheirMeansAlone) {
  const double expected = (2 * 100.0 * 120 + kC1) / (100.0 * 100 + 120.0 * 120 + kC1);
  EXPECT_NEAR(structural_similarity(plain(20, 20, 100, 100, 100), plain(20, 20, 120, 120, 120)), expected, 1e-12);
}

// Windows are centred on columns 5 to 34, of which each mask selects one half.
TEST(Ssim, OfAMaskIsTheMeanOfItsPixels) {
  const image::Image a = textured(40, 30, 3), b = with_noise(a, 200, 60, 2);
  Plane<std::uint8_t> left(40, 30), right(40, 30), border(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) (x < 20 ? left : right).row(y)[x] = 1;
  border.row(0)[7] = 1;
  const double of_left = structural_similarity(a, b, &left), of_right = structural_similarity(a, b, &right);
  EXPECT_NE(of_left, of_right);
  EXPECT_NEAR(structural_similarity(a, b), (of_left + of_right) / 2, 1e-12);
  EXPECT_NEAR(structural_similarity(a, a, &border), 1, 1e-12);
}

// No window fits into the image; the result is still a valid SSIM.
TEST(Ssim, ImagesSmallerThanAWindowAreCompared) {
  EXPECT_NEAR(structural_similarity(textured(7, 5, 1), textured(7, 5, 1)), 1, 1e-12);
  EXPECT_LT(structural_similarity(plain(7, 5, 0, 0, 0), plain(7, 5, 255, 255, 255)), 0.01);
}

}  // namespace
}  // namespace weft::compare
