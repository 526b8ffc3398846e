#include "film/image/shrink.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::image {

Image shrink(const Image& image, int width) {
  if (width >= image.width) return image;
  const double scale = static_cast<double>(image.width) / width;
  Image small(width, std::max(1, static_cast<int>(std::lround(image.height / scale))));
  // Along one axis, index of the first of `size` old pixels that new pixel i of `count` covers.
  const auto edge = [](int i, int count, int size) {
    return static_cast<int>(static_cast<long long>(i) * size / count);
  };
  for (int y = 0; y < small.height; ++y) {
    const int top = edge(y, small.height, image.height),
              bottom = std::max(top + 1, edge(y + 1, small.height, image.height));
    for (int x = 0; x < width; ++x) {
      const int left = edge(x, width, image.width), right = std::max(left + 1, edge(x + 1, width, image.width));
      std::array<long long, 3> sum{};
      for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column)
          for (std::size_t c = 0; c < 3; ++c) sum[c] += image.pixel(column, row)[c];
      const long long count = static_cast<long long>(bottom - top) * (right - left);
      for (std::size_t c = 0; c < 3; ++c)
        small.pixel(x, y)[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    }
  }
  return small;
}

}  // namespace weft::image
