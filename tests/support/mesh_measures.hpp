// Measures of meshes by which tests judge them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "mesh/geometry.hpp"

namespace weft::support {

/// Volume [m³] inside a watertight mesh; positive where the triangles are counter-clockwise seen from outside.
inline double enclosed_volume(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions) {
  // Signed tetrahedra over each triangle. Their common tip lies on the mesh: far from it, large terms would cancel.
  double sum = 0;
  for (const mesh::Triangle& t : triangles)
    sum += mesh::area_vector(t, positions).dot(positions[t[0]] - positions[0]) / 3;
  return sum;
}

/// Manifold without border: encloses a volume.
inline bool watertight(const mesh::TopologyReport& report) {
  return report.manifold() && report.border.empty();
}

/// Smallest angle of a triangle [degrees]; negative where it is clockwise.
inline double smallest_angle(const mesh::Triangle& triangle, std::span<const Vec2> points) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec2& p = points[triangle[k]];
    const Vec2 a = points[triangle[(k + 1) % 3]] - p, b = points[triangle[(k + 2) % 3]] - p;
    least = std::min(least, std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
  }
  return least * 180 / std::numbers::pi;
}

}  // namespace weft::support
