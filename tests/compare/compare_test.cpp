#include "tools/compare/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "compare/pictures.hpp"
#include "core/error.hpp"
#include "film/image/color.hpp"
#include "support/test_folder.hpp"

namespace weft::compare {
namespace {

TEST(Compare, EqualImagesAreTheSame) {
  const image::Image a = textured(64, 36, 1);
  const Comparison result = compare(a, a, 4);
  EXPECT_EQ(result.figures.pixels_changed, 0);
  EXPECT_EQ(result.figures.ssim, 1);
  EXPECT_EQ(result.figures.flip, 0);
  EXPECT_EQ(verdict(result.figures, {}), Verdict::same);
}

TEST(Compare, CountsPixelsOnceAndNamesTheFirstOfTheLargest) {
  const image::Image a = plain(20, 10, 100, 100, 100);
  image::Image b = a;
  b.pixel(3, 2)[0] = 104;  // at the tolerance
  b.pixel(5, 2)[1] = 95;   // beyond it
  for (int c = 0; c < 3; ++c) b.pixel(7, 4)[c] = 90;
  b.pixel(9, 4)[2] = 110;  // as large, but later in the picture
  const Figures figures = compare(a, b, 4).figures;
  EXPECT_EQ(figures.pixels_changed, 4);
  EXPECT_EQ(figures.pixels_over, 3);
  EXPECT_EQ(figures.largest, 10);
  EXPECT_EQ(figures.largest_x, 7);
  EXPECT_EQ(figures.largest_y, 4);
  EXPECT_EQ(figures.fraction_over(), 3 / 200.0);
}

TEST(Compare, EachLimitDecidesByItself) {
  Figures figures;
  figures.width = figures.height = 100;
  figures.pixels = 10000;
  figures.pixels_changed = 500;
  Limits limits;
  limits.pixel_budget = 0.01;
  limits.flip = 0.1;
  limits.spot = 0.4;
  figures.pixels_over = 100;
  figures.flip = 0.1;
  figures.spot = 0.4;
  EXPECT_EQ(verdict(figures, limits), Verdict::within);
  figures.pixels_over = 101;
  EXPECT_EQ(verdict(figures, limits), Verdict::differs);
  figures.pixels_over = 0;
  figures.flip = 0.1001;
  EXPECT_EQ(verdict(figures, limits), Verdict::differs);
  figures.flip = 0;
  figures.spot = 0.4001;
  EXPECT_EQ(verdict(figures, limits), Verdict::differs);
}

TEST(Compare, ImagesOfDifferentSizeAreNotForThisFunction) {
  support::expect_error(ExitCode::internal, "20x10 and 10x20",
                        [] { compare(plain(20, 10, 0, 0, 0), plain(10, 20, 0, 0, 0), 4); });
}

TEST(Compare, FiguresAreTheMeanAndTheLargestOfTheMap) {
  const image::Image a = textured(90, 70, 1);
  const Comparison result = compare(a, with_noise(a, 900, 40, 7), 4);
  double sum = 0;
  for (const float value : result.flip.values) sum += static_cast<double>(value);
  EXPECT_NEAR(result.figures.flip, sum / 6300, 1e-12);
  EXPECT_GT(result.figures.flip, 0);
  EXPECT_EQ(result.figures.spot, *std::max_element(result.flip.values.begin(), result.flip.values.end()));
}

// Verdict on a flat picture of 320x180 in which a square of `size` × `size` pixels is `levels` brighter.
Verdict verdict_of_speck(int size, int levels) {
  const image::Image flat = plain(320, 180, 110, 110, 110);
  image::Image speck = flat;
  for (int y = 0; y < size; ++y)
    std::fill_n(speck.pixel(100, 90 + y), 3 * size, static_cast<std::uint8_t>(110 + levels));
  return verdict(compare(flat, speck, Limits{}.pixel_tolerance).figures, {});
}

TEST(Compare, DefaultsPassOneSampleOfOnePixelAndNoSpeckOfSeveral) {
  EXPECT_EQ(verdict_of_speck(1, 64), Verdict::within);
  EXPECT_EQ(verdict_of_speck(2, 32), Verdict::differs);
  EXPECT_EQ(verdict_of_speck(3, 8), Verdict::differs);
  EXPECT_EQ(verdict_of_speck(1, 120), Verdict::differs);
}

/// Blue cloth in front of a light floor. The edge is at (x + 0.3 y) = `at`, drawn with four samples per pixel.
image::Image edge_at(double at, int width = 480, int height = 270) {
  image::Image image = plain(width, height, 200, 190, 180);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int inside = 0;
      for (int k = 0; k < 4; ++k) inside += x + 0.25 * k + 0.3 * (y + (k * 3 % 4) * 0.25) < at;
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = static_cast<std::uint8_t>((4 * (200 - 10 * c) - inside * (150 - 60 * c)) / 4);
    }
  }
  return image;
}

/// Moves one of the four samples of a pixel to the other side of the edge, in `count` pixels that are `apart` rows from
/// each other.
image::Image with_flipped_samples(const image::Image& image, int count, int apart) {
  image::Image flipped = image;
  for (int i = 0, y = 2; i < count; ++i, y += apart) {
    int x = 0;  // the first pixel with both cloth and floor
    while (image.pixel(x, y)[0] < 80) ++x;
    for (int c = 0; c < 3; ++c) flipped.pixel(x, y)[c] = static_cast<std::uint8_t>(image.pixel(x, y)[c] - 10 + 3 * c);
  }
  return flipped;
}

// Measured difference between CPU types: up to 27 of 129,600 pixels, at edges, in groups of up to 3.
TEST(Compare, DefaultsPassSingleSamplesOfAnEdge) {
  const image::Image edge = edge_at(150.3);
  const Figures figures = compare(edge, with_flipped_samples(edge, 27, 8), 4).figures;
  EXPECT_EQ(figures.pixels_over, 27);
  EXPECT_EQ(figures.pixels_at_edges, 27);
  EXPECT_DOUBLE_EQ(counted_pixels(figures, {}), 27 / 40.0);
  EXPECT_EQ(verdict(figures, {}), Verdict::within);
  EXPECT_EQ(verdict(figures, {.pixel_budget = 1e-4}), Verdict::differs) << "a budget that is given counts all";
  EXPECT_EQ(verdict(figures, {.pixel_budget = Limits::kPixelBudget}), Verdict::differs) << "the default value too";
}

TEST(Compare, DefaultsCatchAnEdgeThatMoves) {
  const image::Image edge = edge_at(150.3);
  const Figures moved = compare(edge, edge_at(150.6), 4).figures;
  EXPECT_GT(moved.pixels_over, 100);
  EXPECT_EQ(verdict(moved, {}), Verdict::differs);
  const Figures run = compare(edge, with_flipped_samples(edge, 5, 1), 4).figures;
  EXPECT_EQ(run.pixels_over, 5);
  EXPECT_EQ(run.pixels_at_edges, 0) << "five together are more than samples";
  EXPECT_EQ(verdict(run, {}), Verdict::differs);
}

/// Number of pixels that count fully if a square spot on the cloth of `edge_at` appears or disappears.
std::int64_t full_pixels_of_spot(bool is_missing, int size, int levels) {
  const image::Image without = edge_at(150.3);
  image::Image with = without;
  for (int y = 100; y < 100 + size; ++y)
    for (int x = 40; x < 40 + size; ++x)
      for (int c = 0; c < 3; ++c) with.pixel(x, y)[c] = static_cast<std::uint8_t>(with.pixel(x, y)[c] + levels);
  const Figures figures = is_missing ? compare(with, without, 4).figures : compare(without, with, 4).figures;
  return figures.pixels_over - figures.pixels_at_edges;
}

TEST(Compare, SpotsThatComeOrGoCountInFull) {
  for (const int size : {1, 2}) {
    EXPECT_EQ(full_pixels_of_spot(false, size, 12), size * size) << "a hole";
    EXPECT_EQ(full_pixels_of_spot(true, size, 12), size * size) << "a button that is gone";
  }
}

TEST(Compare, OnlyTheDefaultMeanIsWiderInSmallPictures) {
  Figures figures;
  figures.width = 160, figures.height = 90;
  EXPECT_DOUBLE_EQ(*for_size({}, figures).flip, 4 * Limits::kFlip);
  for (const double given : {1e-3, Limits::kFlip}) EXPECT_EQ(for_size({.flip = given}, figures).flip, given);
  figures.width = 1280, figures.height = 720;
  EXPECT_EQ(for_size({}, figures).flip, Limits::kFlip);
}

// The noise is as large as the measured differences between CPU types in four pictures.
TEST(Compare, DefaultsPassTheNoiseOfProcessors) {
  const image::Image picture = textured(320, 180, 1);
  EXPECT_EQ(verdict(compare(picture, with_noise(picture, 60, 1, 5), 4).figures, {}), Verdict::within);
}

// One level is invisible, but everywhere it is a change of the light; the mean FLIP distinguishes it from noise.
TEST(Compare, DefaultsCatchOneLevelEverywhere) {
  EXPECT_EQ(verdict(compare(plain(320, 180, 150, 150, 150), plain(320, 180, 151, 151, 151), 4).figures, {}),
            Verdict::differs);
}

/// Figures of a frame that differs a little everywhere.
Figures mild(double flip) {
  Figures figures;
  figures.pixels = 1000, figures.pixels_changed = 900, figures.pixels_over = 10;
  figures.flip = flip, figures.spot = 0.1;
  return figures;
}

/// Whether frame 20 - `before`, with the figures `frame`, counts as spill (see is_spill) of frame 20, whose mean FLIP
/// is `changed`.
bool is_spill_of(const Figures& frame, double changed, std::size_t before = 2) {
  std::vector<Figures> frames(40);
  for (Figures& other : frames) other.pixels = 1000;
  frames[20] = mild(changed);
  frames[20 - before] = frame;
  return is_spill(frames, 20 - before, with_encoder_noise({}));
}

TEST(Compare, SpillIsNearAChangedFrameAndLessThanAThirdOfIt) {
  EXPECT_TRUE(is_spill_of(mild(0.025), 0.1));
  EXPECT_TRUE(is_spill_of(mild(0.025), 0.1, 12));
  EXPECT_FALSE(is_spill_of(mild(0.025), 0.1, 13));
  EXPECT_TRUE(is_spill_of(mild(0.025), 0.0751));
  EXPECT_FALSE(is_spill_of(mild(0.025), 0.0749));
}

TEST(Compare, SpillExceedsOnlyLimitsOfMeansAndByLessThanTwice) {
  const double limit = *with_encoder_noise({}).flip;
  EXPECT_TRUE(is_spill_of(mild(1.99 * limit), 1));
  EXPECT_FALSE(is_spill_of(mild(2.01 * limit), 1));
  Figures spotted = mild(0.025), scattered = spotted;
  spotted.spot = 0.5;
  scattered.pixels_over = 60;
  EXPECT_FALSE(is_spill_of(spotted, 1));
  EXPECT_FALSE(is_spill_of(scattered, 1));
}

TEST(Compare, SpillIsMeasuredByTheLimitsOfTheVerdict) {
  Figures frame = mild(1.5 * 4 * Limits::kFlip), changed = mild(1);  // in small pictures, the limit is 4 times as large
  for (Figures* figures : {&frame, &changed}) figures->width = 160, figures->height = 90, figures->pixels = 160 * 90;
  frame.pixels_over = frame.pixels_at_edges = 20;  // at edges, they count as half a pixel
  EXPECT_EQ(verdict(frame, {}), Verdict::differs);
  EXPECT_TRUE(is_spill(std::array{frame, changed}, 0, {}));
  frame.flip *= 2;
  EXPECT_FALSE(is_spill(std::array{frame, changed}, 0, {}));
}

TEST(Compare, HeatMapShowsTheSquareRootOfTheMapOnTheHeatScale) {
  Plane<float> map(3, 1);
  map.values = {0, 0.25f, 1};
  const image::Image picture = heat_map(map);
  const std::array<double, 3> positions = {0, 0.5, 1};
  for (int x = 0; x < 3; ++x) {
    const Vec3 expected = 255 * image::srgb_from_linear(image::heat_color(positions[x]));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(picture.pixel(x, 0)[c], expected[c], 1.5) << x;  // tolerance: the colour map has 256 steps
  }
}

}  // namespace
}  // namespace weft::compare
