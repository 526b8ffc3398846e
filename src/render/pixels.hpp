// Pixels as they are read from OpenGL: R, G, B, A of 16 bits, sRGB encoded, the lowest row first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "image/image.hpp"

namespace weft::render {

/// Linear light of one pixel, 0 to 1.
Eigen::Vector3f linear_of(std::uint64_t rgba);
/// And back; alpha is 1.
std::uint64_t encoded(const Eigen::Vector3f& linear);

/// Top row first, with bytes: half a level of noise either way keeps wide gradients from showing their steps.
image::Image to_image(std::span<const std::uint64_t> rgba, int width, int height);
image::Image16 to_image16(std::span<const std::uint64_t> rgba, int width, int height);

}  // namespace weft::render
