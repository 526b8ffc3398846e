// Pixels in the format read from OpenGL: R, G, B, A of 16 bits, sRGB encoded, lowest row first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "film/image/image.hpp"

namespace weft::render {

/// Linear colour of one pixel, 0 to 1.
Eigen::Vector3f linear_of(std::uint64_t rgba);
/// Inverse of linear_of(). Clamps `linear` to 0 to 1; alpha is 1.
std::uint64_t encode(const Eigen::Vector3f& linear);

/// 8-bit image, top row first. Dithers by up to half a level, so that smooth gradients show no bands.
image::Image to_image(std::span<const std::uint64_t> rgba, int width, int height);
/// 16-bit image, top row first, not dithered.
image::Image16 to_image16(std::span<const std::uint64_t> rgba, int width, int height);

}  // namespace weft::render
