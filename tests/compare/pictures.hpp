// Synthetic pictures for the tests of comparison.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "film/image/image.hpp"

namespace weft::compare {

/// A picture of one colour.
inline image::Image plain(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  image::Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = red;
    image.rgb[i + 1] = green;
    image.rgb[i + 2] = blue;
  }
  return image;
}

/// Pseudo-random numbers that are the same on all machines (xorshift, Marsaglia 2003).
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : state_(seed) {}
  /// 0 to `count` - 1.
  int below(int count) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return static_cast<int>(state_ % static_cast<std::uint32_t>(count));
  }

 private:
  std::uint32_t state_;
};

/// A picture with the features of a rendered one: waves, an edge and some grain.
inline image::Image textured(int width, int height, std::uint32_t seed) {
  image::Image image(width, height);
  Noise noise(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double wave = 60 * std::sin(0.21 * x + 0.13 * y) + (x > 2 * y ? 40 : 0);
      for (int c = 0; c < 3; ++c) {
        const double value = 100 + wave * (1 - 0.3 * c) + noise.below(9);
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
  }
  return image;
}

/// Adds random values from -`levels` to `levels` to `count` randomly chosen channels.
inline image::Image with_noise(image::Image image, int count, int levels, std::uint32_t seed) {
  Noise noise(seed);
  for (int i = 0; i < count; ++i) {
    std::uint8_t& value = image.rgb[noise.below(static_cast<int>(image.rgb.size()))];
    value = static_cast<std::uint8_t>(std::clamp(value + noise.below(2 * levels + 1) - levels, 0, 255));
  }
  return image;
}

}  // namespace weft::compare
