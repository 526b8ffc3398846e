#include "film/render/pixels.hpp"

#include <algorithm>
#include <cmath>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

constexpr int kLevels = 1 << 16;

const std::vector<float>& linear_table() {
  static const std::vector<float> kTable = [] {
    std::vector<float> table(kLevels);
    for (int k = 0; k < kLevels; ++k)
      table[k] = static_cast<float>(image::linear_from_srgb(static_cast<double>(k) / (kLevels - 1)));
    return table;
  }();
  return kTable;
}

float channel(std::uint64_t rgba, int which) {
  // Converts from 32 bits to float, because the compiler does not vectorise the conversion from 64 bits.
  return static_cast<float>(static_cast<int>(static_cast<std::uint32_t>(rgba >> (16 * which)) & 0xFFFF));
}

/// Interleaved gradient noise in [0, 1); same as pixel_noise() in shaders/frame.glsl.
float noise(int x, int y) {
  const float along = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float wide = 52.9829189f * (along - std::floor(along));
  return wide - std::floor(wide);
}

}  // namespace

Eigen::Vector3f linear_of(std::uint64_t rgba) {
  const std::vector<float>& table = linear_table();
  return {table[rgba & 0xFFFF], table[rgba >> 16 & 0xFFFF], table[rgba >> 32 & 0xFFFF]};
}

std::uint64_t encode(const Eigen::Vector3f& linear) {
  const Vec3 srgb = image::srgb_from_linear(linear.cast<double>().cwiseMax(0).cwiseMin(1).eval());
  std::uint64_t rgba = std::uint64_t{0xFFFF} << 48;
  for (int k = 0; k < 3; ++k) rgba |= static_cast<std::uint64_t>(std::lround(srgb[k] * (kLevels - 1))) << (16 * k);
  return rgba;
}

image::Image to_image(std::span<const std::uint64_t> rgba, int width, int height) {
  image::Image image(width, height);
  std::vector<float> row_noise(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    const std::uint64_t* from = rgba.data() + static_cast<std::size_t>(height - 1 - y) * width;
    std::uint8_t* to = image.pixel(0, y);
    for (int x = 0; x < width; ++x) row_noise[x] = noise(x, y);
    for (int x = 0; x < width; ++x) {
      for (int k = 0; k < 3; ++k)
        to[3 * x + k] = static_cast<std::uint8_t>(
            static_cast<int>(std::min(channel(from[x], k) * (1 / 257.0f) + row_noise[x], 255.0f)));
    }
  }
  return image;
}

image::Image16 to_image16(std::span<const std::uint64_t> rgba, int width, int height) {
  image::Image16 image{width, height, {}};
  image.rgb.reserve(3 * rgba.size());
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const std::uint64_t pixel = rgba[static_cast<std::size_t>(y) * width + x];
      for (int k = 0; k < 3; ++k) image.rgb.push_back(static_cast<std::uint16_t>(pixel >> (16 * k) & 0xFFFF));
    }
  }
  return image;
}

}  // namespace weft::render
