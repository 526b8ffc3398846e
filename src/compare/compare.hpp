// How two images of one size differ: in numbers, and as a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "compare/plane.hpp"
#include "image/image.hpp"

namespace weft::compare {

/// What may differ before two images count as different. The defaults let through what another CPU or Mesa makes of the
/// same scene: single pixels at edges of cloth, shadows and prints (README, decisions). They do not let through what is
/// seen when one flips between the images.
struct Limits {
  int pixel_tolerance = 4;  ///< levels of 255 by which the channels of a pixel may differ
  /// Share of the pixels that may differ by more. Of the default, a pixel at an edge (`Figures::pixels_at_edges`) uses
  /// a fortieth of one, and any picture may have one pixel.
  double pixel_budget = 2e-5;
  /// Mean of the FLIP map: against what is small but everywhere; one level on 2 % of it. Wider in small pictures, if it
  /// is the default: see `for_size`.
  double flip = 5e-4;
  /// Largest value of the FLIP map: against spots few enough for the budget. One of four samples of a pixel on the
  /// wrong side of an edge makes up to 0.25, a speck of 2x2 pixels 64 levels off or 3x3 pixels 32 levels off more.
  double spot = 0.3;
};

/// Those of the limits that are the defaults, widened for videos that an encoder has changed: it makes much of little
/// where it cuts gradients into blocks. Measured with pictures of another CPU type in H.264 at crf 18: up to 1.35 % of
/// the pixels over the tolerance, FLIP 0.011, spots of 0.28; twice that, spots 0.4.
Limits with_encoder_noise(Limits limits);

/// Where two images are compared: not where it is 0.
using Mask = Plane<std::uint8_t>;

struct Figures {
  int width = 0, height = 0;         ///< pixels
  std::int64_t pixels = 0;           ///< that were compared: all, or those of the mask
  std::int64_t pixels_changed = 0;   ///< pixels that differ at all
  std::int64_t pixels_over = 0;      ///< those that differ by more than the tolerance
  std::int64_t pixels_at_edges = 0;  ///< of these, few together and as what is beside them: see `count_at_edges`
  int largest = 0;                   ///< difference of any channel [levels of 255]
  int largest_x = 0, largest_y = 0;  ///< where it is first, reading like text; pixels from the left and the top
  double ssim = 1;                   ///< mean structural similarity, 1 where equal
  double flip = 0;                   ///< mean of the FLIP map over the pixels compared, 0 where equal
  double spot = 0;                   ///< its largest value

  double share_over() const { return static_cast<double>(pixels_over) / static_cast<double>(pixels); }
};

enum class Verdict {
  same,     ///< equal in every pixel
  within,   ///< differs, within the limits
  differs,  ///< past a limit
};

struct Comparison {
  Figures figures;
  Plane<float> flip;  ///< for each pixel 0 (looks the same) to 1
};

/// Outside of the mask, which may be null, the test counts as equal to the reference. Throws Error(internal) for images
/// and masks of different size or without pixels.
Comparison compare(const image::Image& reference, const image::Image& test, int pixel_tolerance,
                   const Mask* mask = nullptr);

/// The default limit of the mean of FLIP is for pictures of 640x360 pixels and more. In smaller ones edges are a larger
/// share of the pixels, by the root of the ratio of areas, and so is the limit.
Limits for_size(Limits limits, const Figures& figures);

/// What is held against the budget, and what that allows [pixels]; not whole.
double counted_pixels(const Figures& figures, const Limits& limits);
double allowed_pixels(const Figures& figures, const Limits& limits);

Verdict verdict(const Figures& figures, const Limits& limits);

/// Whether frame k of a lossy video, which differs, does so only because the encoder predicted it from a changed frame
/// within half a second: it exceeds the limits of means alone, by less than twice, and differs by at most a third of
/// that frame. `frames`: of the whole video, in their order.
bool is_spill(std::span<const Figures> frames, std::size_t k, const Limits& limits);

/// The FLIP map in the heat colours of `image::heat_color`, from dark blue for 0, with the position on the scale the
/// square root of the value, because what a test must find is small: 0.01 is at a tenth of the scale.
image::Image heat_map(const Plane<float>& flip);

}  // namespace weft::compare
