// Difference of two images of the same size, as numbers and as a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "film/image/image.hpp"
#include "tools/compare/plane.hpp"

namespace weft::compare {

/// Limits beyond which two images count as different. The defaults tolerate differences between CPU
/// types: single pixels at the edges of cloth, shadows and printed patterns (README.md in this
/// folder, Decisions). The defaults reject differences that a viewer sees if the images alternate.
struct Limits {
  static constexpr double kPixelBudget = 2e-5, kFlip = 5e-4, kSpot = 0.3;  ///< defaults of the limits below

  int pixel_tolerance = 4;  ///< largest tolerated difference of a channel [levels of 255]
  /// Fraction of the pixels that may differ by more than pixel_tolerance. If it is not given, two more rules hold: a
  /// pixel at an edge (`Figures::pixels_at_edges`) counts as 1/40 of a pixel, and at least one pixel may differ.
  std::optional<double> pixel_budget = {};
  /// Limit on the mean of the FLIP map. It detects small differences of many pixels: the default corresponds to a
  /// difference of one level at 2 % of the pixels. `for_size` raises the default for small pictures.
  std::optional<double> flip = {};
  /// Limit on the largest value of the FLIP map. It detects spots with fewer pixels than the budget
  /// allows: a spot of 2x2 pixels that differs by 64 levels, or one of 3x3 pixels by 32 levels. If
  /// one of the four samples of a pixel falls on the wrong side of an edge, the FLIP value of this
  /// pixel is up to 0.25, which the default tolerates.
  std::optional<double> spot = {};
};

/// For lossy videos: sets wider values of those limits that are not given, since the encoder
/// amplifies small differences where it divides gradients into coding blocks. Measured between
/// H.264 videos at crf 18 from two CPU types: up to 1.35 % of the pixels over the tolerance, mean
/// FLIP 0.011, largest FLIP 0.28. The wider limits are twice the first two values, and 0.4 for the
/// largest FLIP.
Limits with_encoder_noise(Limits limits);

/// Selects the pixels that are compared: those whose value is not 0.
using Mask = Plane<std::uint8_t>;

/// Measured differences of two images.
struct Figures {
  int width = 0, height = 0;         ///< [pixels]
  std::int64_t pixels = 0;           ///< pixels that were compared: all, or those of the mask
  std::int64_t pixels_changed = 0;   ///< pixels that differ at all
  std::int64_t pixels_over = 0;      ///< pixels that differ by more than the tolerance
  std::int64_t pixels_at_edges = 0;  ///< those of pixels_over that `count_at_edges` (edges.hpp) counts
  int largest = 0;                   ///< largest difference of any channel of any pixel [levels of 255]
  int largest_x = 0, largest_y = 0;  ///< first pixel with this difference, row by row from the top left
  double ssim = 1;                   ///< mean structural similarity of the compared pixels, 1 if equal
  double flip = 0;                   ///< mean of the FLIP map over the compared pixels, 0 if equal
  double spot = 0;                   ///< largest value of the FLIP map

  double fraction_over() const { return static_cast<double>(pixels_over) / static_cast<double>(pixels); }
};

enum class Verdict {
  same,     ///< equal in every pixel
  within,   ///< differs, but not beyond a limit
  differs,  ///< exceeds a limit
};

/// All results for one pair of images.
struct Comparison {
  Figures figures;
  Plane<float> flip;  ///< per pixel, 0 (looks the same) to 1
};

/// Compares two images. Pixels outside `mask` count as equal (null: there is no mask). Throws Error(internal) if images
/// or mask differ in size, or if there are no pixels to compare.
Comparison compare(const image::Image& reference, const image::Image& test, int pixel_tolerance,
                   const Mask* mask = nullptr);

/// Sets `flip` to its default if it is not given. If the picture has fewer than 640x360 pixels, the default is
/// multiplied by √(640 · 360 / number of pixels), since edges cover a larger fraction of a small picture.
Limits for_size(Limits limits, const Figures& figures);

/// Number of pixels that count against the budget; fractional if edge pixels count as 1/40.
double counted_pixels(const Figures& figures, const Limits& limits);
/// Number of pixels that may differ by more than the tolerance; can be fractional.
double allowed_pixels(const Figures& figures, const Limits& limits);

/// Whether the figures are within all limits.
Verdict verdict(const Figures& figures, const Limits& limits);

/// Whether frame k of a lossy video is spill: the frame differs only because the encoder predicted it from a changed
/// frame nearby. Call it for frames with the verdict `differs`. Conditions: the counted pixels and the mean FLIP are at
/// most twice their limits, `spot` is within its limit, and the mean FLIP is at most a third of the largest mean FLIP
/// of the frames up to 12 frames away. `frames`: all frames of the video, in order.
bool is_spill(std::span<const Figures> frames, std::size_t k, const Limits& limits);

/// The FLIP map in the colours of `image::heat_color`, with dark blue for 0. The position on the colour scale is the
/// square root of the value, so that small differences are visible: 0.01 is at a tenth of the scale.
image::Image heat_map(const Plane<float>& flip);

}  // namespace weft::compare
