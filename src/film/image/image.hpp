// An RGB picture in sRGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weft::image {

/// A picture. Row-major, top row first, three bytes (R, G, B) per pixel, sRGB encoded.
struct Image {
  int width = 0;   ///< [pixels]
  int height = 0;  ///< [pixels]
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}

  std::uint8_t* pixel(int x, int y) { return rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x); }
  const std::uint8_t* pixel(int x, int y) const { return rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x); }
};

/// The same as Image, but with 16 bits per channel.
struct Image16 {
  int width = 0, height = 0;
  std::vector<std::uint16_t> rgb;
};

}  // namespace weft::image
