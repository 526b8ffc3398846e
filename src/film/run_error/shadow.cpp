#include "film/run_error/shadow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace weft::run_error {
namespace {

// Number of scan lines. With 1000 lines, the area of a disc has a relative error of 1e-5.
constexpr int kLines = 1000;

using Interval = std::pair<double, double>;

// Intersection of a triangle with the horizontal line at height y.
Interval intersect_line(const std::array<Vec2, 3>& corners, double y) {
  Interval interval{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % 3];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    interval.first = std::min(interval.first, x);
    interval.second = std::max(interval.second, x);
  }
  return interval;
}

double length_of_union(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0, end = -std::numeric_limits<double>::infinity();
  for (const Interval& interval : intervals) {
    length += std::max(0.0, interval.second - std::max(end, interval.first));
    end = std::max(end, interval.second);
  }
  return length;
}

}  // namespace

double shadow_area(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions, const Vec3& up) {
  if (triangles.empty()) return 0;
  const Vec3 across = up.unitOrthogonal(), along = up.cross(across);
  std::vector<Vec2> flat;
  for (const Vec3& x : positions) flat.emplace_back(across.dot(x), along.dot(x));
  const auto [lowest, highest] =
      std::minmax_element(flat.begin(), flat.end(), [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
  const double low = lowest->y(), spacing = (highest->y() - low) / kLines;
  if (!(spacing > 0)) return 0;

  std::vector<std::vector<Interval>> lines(kLines);
  for (const mesh::Triangle& triangle : triangles) {
    const auto corner = [&](std::size_t k) { return flat[static_cast<std::size_t>(triangle[k])]; };
    const std::array<Vec2, 3> corners{corner(0), corner(1), corner(2)};
    const auto [low_y, high_y] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const int last = std::min(kLines - 1, static_cast<int>((high_y - low) / spacing));
    for (int line = static_cast<int>((low_y - low) / spacing); line <= last; ++line) {
      const Interval interval = intersect_line(corners, low + (line + 0.5) * spacing);
      if (interval.first < interval.second) lines[static_cast<std::size_t>(line)].push_back(interval);
    }
  }
  double area = 0;
  for (std::vector<Interval>& line : lines) area += spacing * length_of_union(line);
  return area;
}

}  // namespace weft::run_error
