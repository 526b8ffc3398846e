// Two features of surfaces (vertex and face, or edge and edge), with a point on each.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/types.hpp"

namespace weft::collision {

enum class ProximityKind : std::uint8_t { vertex_face, edge_edge };

/// Identifies two features, whatever the order of their vertices. The first entry is negative (~vertex) for a vertex
/// and a face, so the kinds do not mix.
using FeatureKey = std::array<Index, 4>;
inline FeatureKey feature_key(ProximityKind kind, FeatureKey vertices) {
  if (kind == ProximityKind::vertex_face) {
    std::sort(vertices.begin() + 1, vertices.end());
    vertices[0] = ~vertices[0];
    return vertices;
  }
  for (std::size_t k : {0, 2})
    if (vertices[k] > vertices[k + 1]) std::swap(vertices[k], vertices[k + 1]);
  if (vertices[0] > vertices[2] || (vertices[0] == vertices[2] && vertices[1] > vertices[3]))
    return {vertices[2], vertices[3], vertices[0], vertices[1]};
  return vertices;
}

/// Points of the two features: x_a = Σ w x over the positive weights w on side a, x_b = −Σ w x over the negative ones
/// on side b. A vertex of weight 0 need not belong to either feature.
struct FeaturePair {
  std::array<Index, 4> vertices{};  ///< vertex, then the corners of the face; or the ends of edge a, then of edge b
  std::array<double, 4> weights{};  ///< those of side a sum to 1, those of side b to −1
  Vec3 normal = Vec3::UnitZ();      ///< unit, from x_b to x_a
  double distance = 0;              ///< (x_a − x_b) · normal [m]; negative if a is on the wrong side of b
  ProximityKind kind = ProximityKind::vertex_face;
};

}  // namespace weft::collision
