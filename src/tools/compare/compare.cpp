#include "tools/compare/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/error.hpp"
#include "film/image/color.hpp"
#include "tools/compare/edges.hpp"
#include "tools/compare/flip.hpp"
#include "tools/compare/ssim.hpp"

namespace weft::compare {
namespace {

Figures count_pixels(const image::Image& reference, const image::Image& test, int tolerance) {
  Figures figures;
  figures.width = reference.width;
  figures.height = reference.height;
  figures.pixels = static_cast<std::int64_t>(reference.width) * reference.height;
  for (int y = 0; y < reference.height; ++y) {
    const std::uint8_t *a = reference.pixel(0, y), *b = test.pixel(0, y);
    for (int x = 0; x < reference.width; ++x, a += 3, b += 3) {
      const int difference = std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
      figures.pixels_changed += difference > 0;
      figures.pixels_over += difference > tolerance;
      if (difference <= figures.largest) continue;
      figures.largest = difference;
      figures.largest_x = x;
      figures.largest_y = y;
    }
  }
  return figures;
}

double sum_of(const Plane<float>& plane) {
  return parallel_sum(plane.values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(plane.values[i]);
    return part;
  });
}

// Replaces the pixels outside the mask by those of the reference.
image::Image masked(const image::Image& reference, image::Image test, const Mask& mask) {
  if (mask.width != reference.width || mask.height != reference.height) {
    throw Error(ExitCode::internal, "expected a mask of {}x{} pixels, got {}x{}", reference.width, reference.height,
                mask.width, mask.height);
  }
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    if (mask.values[i] == 0) std::copy_n(&reference.rgb[3 * i], 3, &test.rgb[3 * i]);
  return test;
}

// `factor` multiplies the limits on the number of pixels and on mean FLIP, but not `Limits::spot`.
bool is_within(const Figures& figures, const Limits& limits, double factor) {
  return counted_pixels(figures, limits) <= factor * allowed_pixels(figures, limits) &&
         figures.flip <= factor * *for_size(limits, figures).flip &&
         figures.spot <= limits.spot.value_or(Limits::kSpot);
}

}  // namespace

Comparison compare(const image::Image& reference, const image::Image& test, int pixel_tolerance, const Mask* mask) {
  const bool same_size = reference.width == test.width && reference.height == test.height;
  if (!same_size || reference.rgb.empty() || reference.rgb.size() != test.rgb.size()) {
    throw Error(ExitCode::internal, "expected two images of one size to compare, got {}x{} and {}x{}", reference.width,
                reference.height, test.width, test.height);
  }
  std::optional<image::Image> inside;
  if (mask != nullptr) inside = masked(reference, test, *mask);
  const image::Image& shown = inside ? *inside : test;
  Comparison result;
  result.figures = count_pixels(reference, shown, pixel_tolerance);
  if (mask != nullptr)
    result.figures.pixels = std::ranges::count_if(mask->values, [](std::uint8_t value) { return value != 0; });
  if (result.figures.pixels == 0) throw Error(ExitCode::internal, "expected a mask with pixels to compare");
  if (result.figures.pixels_changed == 0) {
    result.flip = Plane<float>(reference.width, reference.height);
    return result;
  }
  if (result.figures.pixels_over > 0)
    result.figures.pixels_at_edges = count_at_edges(reference, shown, pixel_tolerance);
  result.figures.ssim = structural_similarity(reference, shown, mask);
  result.flip = flip_map(reference, shown);
  // FLIP filters the images, so a difference inside the mask near its border also changes the FLIP map outside of it.
  for (std::size_t i = 0; mask != nullptr && i < mask->values.size(); ++i)
    if (mask->values[i] == 0) result.flip.values[i] = 0;
  result.figures.flip = sum_of(result.flip) / static_cast<double>(result.figures.pixels);
  result.figures.spot = static_cast<double>(*std::max_element(result.flip.values.begin(), result.flip.values.end()));
  return result;
}

Limits with_encoder_noise(Limits limits) {
  if (!limits.pixel_budget) limits.pixel_budget = 0.027;
  if (!limits.flip) limits.flip = 0.022;
  if (!limits.spot) limits.spot = 0.4;
  return limits;
}

Limits for_size(Limits limits, const Figures& figures) {
  constexpr double kArea = 640 * 360;
  const double area = std::max(1.0, static_cast<double>(figures.width) * figures.height);
  if (!limits.flip) limits.flip = Limits::kFlip * std::sqrt(std::max(1.0, kArea / area));
  return limits;
}

double counted_pixels(const Figures& figures, const Limits& limits) {
  // With this weight, the default budget allows 2.2 times the largest fraction of edge pixels that
  // differed between CPU types: 21 of 57,600 pixels (README.md in this folder, Decisions).
  constexpr double kEdgePixelWeight = 1.0 / 40;
  const auto over = static_cast<double>(figures.pixels_over), at_edges = static_cast<double>(figures.pixels_at_edges);
  return limits.pixel_budget ? over : (over - at_edges) + kEdgePixelWeight * at_edges;
}

double allowed_pixels(const Figures& figures, const Limits& limits) {
  const auto pixels = static_cast<double>(figures.pixels);
  return limits.pixel_budget ? *limits.pixel_budget * pixels : std::max(1.0, Limits::kPixelBudget * pixels);
}

Verdict verdict(const Figures& figures, const Limits& limits) {
  if (figures.pixels_changed == 0) return Verdict::same;
  return is_within(figures, limits, 1) ? Verdict::within : Verdict::differs;
}

bool is_spill(std::span<const Figures> frames, std::size_t k, const Limits& limits) {
  // Measured in videos of 96x64 pixels in which a square appears for one or two frames: the figures of spill reached
  // 1.3 times the limits, and its mean FLIP 0.29 times that of the changed frame.
  constexpr std::size_t kFrames = 12;
  constexpr double kOverLimit = 2, kMaxFlipRatio = 1.0 / 3;
  if (!is_within(frames[k], limits, kOverLimit)) return false;
  const std::size_t first = k - std::min(k, kFrames), end = std::min(k + kFrames + 1, frames.size());
  const double largest = std::ranges::max(frames.subspan(first, end - first), {}, &Figures::flip).flip;
  return frames[k].flip <= kMaxFlipRatio * largest;
}

image::Image heat_map(const Plane<float>& flip) {
  const auto table = image::heat_table();
  std::array<std::array<std::uint8_t, 3>, image::kHeatColors> colors;
  for (int i = 0; i < image::kHeatColors; ++i) {
    const Vec3 encoded = image::srgb_from_linear(table[i]);
    for (int c = 0; c < 3; ++c) colors[i][c] = static_cast<std::uint8_t>(std::lround(255 * encoded[c]));
  }
  image::Image picture(flip.width, flip.height);
  std::uint8_t* to = picture.rgb.data();
  for (const float value : flip.values) {
    const auto& color = colors[std::lround(std::sqrt(value) * (image::kHeatColors - 1))];
    to = std::copy(color.begin(), color.end(), to);
  }
  return picture;
}

}  // namespace weft::compare
