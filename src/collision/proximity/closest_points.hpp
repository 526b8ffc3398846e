// Closest points of a vertex and a triangle, and of two edges, in closed form.
#pragma once

#include <array>

#include "core/types.hpp"

namespace weft::collision {

/// Closest points x_a = Σ (positive weights) x, x_b = -Σ (negative weights) x of two features with four vertices in
/// all.
struct ClosestPoints {
  std::array<double, 4> weights;  ///< side a ≥ 0, summing to 1; side b ≤ 0, summing to -1
  Vec3 difference;                ///< x_a - x_b [m]
  double distance_sq;             ///< [m²]

  /// Bit i is set where vertex i carries weight. A closest point inside its face has three bits of its side, one on an
  /// edge two, one at a vertex one; weights outside are exactly zero.
  unsigned support() const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= static_cast<unsigned>(weights[i] != 0) << i;
    return bits;
  }
};

/// Point p (side a, weight 0) against triangle t0 t1 t2 (side b, weights 1 to 3), which may be a segment or a point.
/// The weights are always those of a point of the triangle. The distance is right to about 2e-14 of the longest edge for
/// ordinary triangles and 2e-13 for needles of any aspect ratio, wherever in space they are.
ClosestPoints closest_vertex_face(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2);

/// Segment p0 p1 (side a, weights 0, 1) against segment q0 q1 (side b, weights 2, 3), either of which may be a point.
/// Of parallel segments one of the closest pairs is returned, always the same one for the same input.
ClosestPoints closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1);

}  // namespace weft::collision
