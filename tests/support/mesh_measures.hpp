// Measures of the quality of meshes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "physics/mesh/geometry.hpp"

namespace weft::support {

/// Volume [m³] inside a watertight mesh; positive if the triangles are counter-clockwise seen from outside.
inline double enclosed_volume(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions) {
  // Sums signed tetrahedra over the triangles. Their common apex is a vertex of the mesh, since with a distant apex,
  // large terms would cancel.
  double sum = 0;
  for (const mesh::Triangle& t : triangles)
    sum += mesh::area_vector(t, positions).dot(positions[t[0]] - positions[0]) / 3;
  return sum;
}

/// Whether the mesh is manifold without border, so that it encloses a volume.
inline bool watertight(const mesh::TopologyReport& report) {
  return report.manifold() && report.border.empty();
}

/// Smallest angle of a triangle [degrees]; negative if the triangle is clockwise.
inline double smallest_angle(const mesh::Triangle& triangle, std::span<const Vec2> points) {
  double minimum = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec2& p = points[triangle[k]];
    const Vec2 a = points[triangle[(k + 1) % 3]] - p, b = points[triangle[(k + 2) % 3]] - p;
    minimum = std::min(minimum, std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
  }
  return minimum * 180 / std::numbers::pi;
}

}  // namespace weft::support
