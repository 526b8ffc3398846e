#include "tools/compare/edges.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tools/compare/plane.hpp"

namespace weft::compare {
namespace {

// Limit on the pixels of a group. The largest group between pictures drawn with and without
// `GALLIUM_OVERRIDE_CPU_CAPS=sse4.1` has 3 pixels.
constexpr std::size_t kMaxGroupSize = 4;

struct Pixel {
  int x, y;
};

/// Calls body(x, y) for the pixel and those of its eight neighbours that lie inside the image.
template <class Body>
void for_neighbourhood(int width, int height, Pixel p, const Body& body) {
  for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, height - 1); ++y)
    for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, width - 1); ++x) body(x, y);
}

bool is_between_neighbours(const std::uint8_t* value, const image::Image& other, Pixel p, int tolerance) {
  for (int c = 0; c < 3; ++c) {
    int least = 255, largest = 0;
    for_neighbourhood(other.width, other.height, p, [&](int x, int y) {
      least = std::min<int>(least, other.pixel(x, y)[c]);
      largest = std::max<int>(largest, other.pixel(x, y)[c]);
    });
    if (value[c] < least - tolerance || value[c] > largest + tolerance) return false;
  }
  return true;
}

}  // namespace

std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance) {
  const int width = reference.width, height = reference.height;
  Plane<std::uint8_t> over(width, height);  // 1: over the tolerance, and not yet in a group
  for_each_row(height, [&](int y) {
    const std::uint8_t *a = reference.pixel(0, y), *b = test.pixel(0, y);
    std::uint8_t* to = over.row(y);
    for (int x = 0; x < width; ++x, a += 3, b += 3)
      to[x] = std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}) > tolerance ? 1 : 0;
  });
  std::int64_t count = 0;
  std::vector<Pixel> group;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (over.row(y)[x] == 0) continue;
      group.assign(1, {x, y});
      over.row(y)[x] = 0;
      for (std::size_t i = 0; i < group.size(); ++i) {
        for_neighbourhood(width, height, group[i], [&](int next_x, int next_y) {
          if (over.row(next_y)[next_x] == 0) return;
          over.row(next_y)[next_x] = 0;
          group.push_back({next_x, next_y});
        });
      }
      if (group.size() > kMaxGroupSize) continue;
      count += std::ranges::count_if(group, [&](Pixel p) {
        return is_between_neighbours(test.pixel(p.x, p.y), reference, p, tolerance) &&
               is_between_neighbours(reference.pixel(p.x, p.y), test, p, tolerance);
      });
    }
  }
  return count;
}

}  // namespace weft::compare
