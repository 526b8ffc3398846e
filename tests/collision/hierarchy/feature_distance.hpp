// Distance of two triangles, by brute force over their features.
#pragma once

#include <cmath>
#include <span>
#include <utility>

#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/proximity/features.hpp"

namespace weft::collision::testing {

/// Minimum distance [m] of all vertex–face and edge–edge pairs of the triangles without a common vertex; 1e150 if there
/// is no such pair.
inline double feature_distance(const Triangle& a, const Triangle& b, std::span<const Vec3> x) {
  const auto at = [&](Index v) -> const Vec3& { return x[v]; };
  double least_sq = 1e300;
  for (const auto& [own, other] : {std::pair(a, b), std::pair(b, a)})
    for (const Index v : own)
      if (!has_vertex(other, v))
        least_sq = std::min(least_sq, closest_vertex_face(at(v), at(other[0]), at(other[1]), at(other[2])).distance_sq);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::array<Index, 4> v{a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]};
      if (v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3]) continue;
      least_sq = std::min(least_sq, closest_edge_edge(at(v[0]), at(v[1]), at(v[2]), at(v[3])).distance_sq);
    }
  return std::sqrt(least_sq);
}

}  // namespace weft::collision::testing
