// One value per pixel, and the filters shared by the image metrics.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.hpp"

namespace weft::compare {

/// Values of type T, row-major, top row first.
template <class T>
struct Plane {
  int width = 0, height = 0;  ///< pixels
  std::vector<T> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  T* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const T* row(int y) const { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
};

inline constexpr std::size_t kRowsPerChunk = 16;

/// Calls body(y) for each row, in parallel.
template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_for(static_cast<std::size_t>(height), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

namespace detail {

// Convolves each row with `kernel`, which is centred on the pixel.
template <class T>
Plane<T> convolve_rows(const Plane<T>& in, std::span<const T> kernel) {
  const int radius = static_cast<int>(kernel.size() / 2), width = in.width;
  Plane<T> out(width, in.height);
  for_each_row(in.height, [&](int y) {
    // Repeats the ends of the row, so that the loop below needs no special cases there.
    std::vector<T> padded(static_cast<std::size_t>(width + 2 * radius));
    for (int i = 0; i < width + 2 * radius; ++i) padded[i] = in.row(y)[std::clamp(i - radius, 0, width - 1)];
    T* to = out.row(y);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const T weight = kernel[kernel.size() - 1 - k];
      const T* from = padded.data() + k;
      for (int x = 0; x < width; ++x) to[x] += weight * from[x];
    }
  });
  return out;
}

template <class T>
Plane<T> convolve_columns(const Plane<T>& in, std::span<const T> kernel) {
  const int radius = static_cast<int>(kernel.size() / 2);
  Plane<T> out(in.width, in.height);
  for_each_row(in.height, [&](int y) {
    T* to = out.row(y);
    for (int k = -radius; k <= radius; ++k) {
      const T weight = kernel[radius - k];
      const T* from = in.row(std::clamp(y + k, 0, in.height - 1));
      for (int x = 0; x < in.width; ++x) to[x] += weight * from[x];
    }
  });
  return out;
}

}  // namespace detail

/// Convolution with the kernel `column[j] row[i]`. Both have odd lengths, with the origin in the middle. Beyond the
/// border, the outermost pixels are repeated.
template <class T>
Plane<T> convolve(const Plane<T>& in, std::span<const T> row, std::span<const T> column) {
  return detail::convolve_columns(detail::convolve_rows(in, row), column);
}

}  // namespace weft::compare
