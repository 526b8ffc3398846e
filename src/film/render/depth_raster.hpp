// Rasterises triangles on the CPU.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "film/render/transforms.hpp"

namespace weft::render {

/// Rasterises a triangle. Corners: x, y [texels]; z is the depth, which is interpolated linearly.
/// Calls write(index, covered, depth, weight_b, weight_c), row by row, for each texel inside the
/// `width` x `height` texels whose centre is in the bounding box of the triangle. `index`: that of
/// the texel, row by row. `covered`: whether the triangle covers the texel's centre. `weight_b`,
/// `weight_c`: barycentric weights of b and c. Does nothing if the triangle is seen edge-on.
template <class Write>
void fill_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, int width, int height,
                   const Write& write) {
  const float b_x = b.x() - a.x(), b_y = b.y() - a.y(), c_x = c.x() - a.x(), c_y = c.y() - a.y();
  const float area = b_x * c_y - c_x * b_y;
  if (!(std::abs(area) > 1e-12f)) return;  // edge-on
  // First and last texel along one axis whose centre may be inside the triangle. Corners near the near plane may be
  // beyond the range of int.
  const auto first = [](float low) { return static_cast<int>(std::max(0.0f, std::ceil(low - 0.5f))); };
  const auto last = [](float high, int size) {
    return static_cast<int>(std::min(static_cast<float>(size - 1), std::floor(high - 0.5f)));
  };
  const auto [x_min, x_max] = std::minmax({a.x(), b.x(), c.x()});
  const auto [y_min, y_max] = std::minmax({a.y(), b.y(), c.y()});
  if (!(x_max > 0 && y_max > 0 && x_min < static_cast<float>(width) && y_min < static_cast<float>(height))) return;
  const int x0 = first(x_min), x1 = last(x_max, width), y0 = first(y_min), y1 = last(y_max, height);
  // Steps of the barycentric weights of b and c along x.
  const float b_step = c_y / area, c_step = -b_y / area;
  const float depth_b = b.z() - a.z(), depth_c = c.z() - a.z();
  for (int y = y0; y <= y1; ++y) {
    const float dx = static_cast<float>(x0) + 0.5f - a.x(), dy = static_cast<float>(y) + 0.5f - a.y();
    const float b_first = (dx * c_y - c_x * dy) / area, c_first = (b_x * dy - dx * b_y) / area;
    for (int x = x0; x <= x1; ++x) {
      const float step = static_cast<float>(x - x0), to_b = b_first + step * b_step, to_c = c_first + step * c_step;
      // The tolerance closes gaps that rounding would leave between neighbouring triangles.
      const bool covered = std::min(std::min(to_b, to_c), 1 - to_b - to_c) >= -1e-5f;
      write(y * width + x, covered, a.z() + to_b * depth_b + to_c * depth_c, to_b, to_c);
    }
  }
}

/// Clips a triangle in clip space at the near plane and calls `visit(a, b, c)` for each of up to two triangles that
/// remain (Sutherland and Hodgman 1974). `Corner`: a vector of the four clip coordinates, which attributes may follow.
template <class Corner = Eigen::Vector4d, class Visit>
void clip_near(const std::array<Corner, 3>& corners, const Visit& visit) {
  // At least 0 if the corner is on the visible side of the near plane.
  const auto before = [](const Corner& corner) { return corner.w() - corner.z(); };
  std::array<Corner, 4> left;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &from = corners[i], &to = corners[(i + 1) % 3];
    const double there = before(from), next = before(to);
    if (there >= 0) left[count++] = from;
    if ((there >= 0) != (next >= 0)) left[count++] = from + there / (there - next) * (to - from);
  }
  for (std::size_t i = 2; i < count; ++i) visit(left[0], left[i - 1], left[i]);
}

}  // namespace weft::render
