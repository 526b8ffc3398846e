// Two features of surfaces, vertex and face or edge and edge, with a point on each.
#pragma once

#include <array>

#include "core/types.hpp"

namespace weft::collision {

/// The points are x_a = Σ (w > 0) w x and x_b = −Σ (w < 0) w x. A vertex of either feature that carries no weight may
/// stand for neither.
struct FeaturePair {
  std::array<Index, 4> vertices{};  ///< vertex, then the face's corners; or the ends of edge a, then of edge b
  std::array<double, 4> weights{};  ///< those of side a sum to 1, those of side b to −1
  Vec3 normal = Vec3::UnitZ();      ///< unit, from x_b to x_a
  double distance = 0;              ///< (x_a − x_b) · normal [m]; negative where a is on the wrong side of b
};

}  // namespace weft::collision
