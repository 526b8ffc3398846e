// Closest points of a vertex and a triangle, and of two edges, in closed form.
#pragma once

#include <algorithm>
#include <array>

#include "core/types.hpp"

namespace weft::collision {

/// Below this sine² between two edges their cross product has lost so many digits that the inner solution is refined
/// and the boundary looked at as well. At the limit 1e-16 / 1e-2 is lost in the plane, relative to the edges.
inline constexpr double kNearlyParallelSq = 1e-4;

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
/// The weights are always those of a point of the triangle. The distance is right to about 2e-14 of the longest edge
/// for ordinary triangles and 2e-13 for needles of any aspect ratio, wherever in space they are.
ClosestPoints closest_vertex_face(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2);

/// Segment p0 p1 (side a, weights 0, 1) against segment q0 q1 (side b, weights 2, 3), either of which may be a point.
/// Of parallel segments one of the closest pairs is returned, always the same one for the same input.
ClosestPoints closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1);

/// A quick look before closest_vertex_face: true only if the distance is above √reach_sq for certain. The distance to
/// the plane, and beyond an edge the one to the plane through that edge upright on the face, are lower bounds.
inline bool surely_farther(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2, double reach_sq) {
  constexpr double kSafety = 1 + 1e-6;  // far above the rounding of the products
  const Vec3 e1 = t1 - t0, e2 = t2 - t0, w = p - t0;
  const Vec3 n = e1.cross(e2);
  const double n_sq = n.squaredNorm(), height = w.dot(n);
  const double limit = kSafety * reach_sq * n_sq;
  if (height * height > limit) return true;
  const double b1 = w.cross(e2).dot(n), b2 = e1.cross(w).dot(n), b0 = n_sq - b1 - b2;
  const auto beyond = [&](double b, double edge_sq) { return b < 0 && b * b > limit * edge_sq; };
  return beyond(b1, e2.squaredNorm()) || beyond(b2, e1.squaredNorm()) || beyond(b0, (e2 - e1).squaredNorm());
}

/// As surely_farther, for two edges: the distance of the lines they lie on is a lower bound.
inline bool surely_farther_edges(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double reach_sq) {
  constexpr double kSafety = 1 + 1e-6;
  const Vec3 d = p1 - p0, e = q1 - q0;
  const Vec3 n = d.cross(e);
  const double n_sq = n.squaredNorm(), height = (q0 - p0).dot(n);
  return n_sq > kNearlyParallelSq * kSafety * d.squaredNorm() * e.squaredNorm() &&
         height * height > kSafety * reach_sq * n_sq;
}

/// A quick look before closest_edge_edge: true only if its closest points are not inside both edges, or farther apart
/// than √reach_sq.
inline bool surely_not_inside(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double reach_sq) {
  constexpr double kSafety = 1 + 1e-6;
  const Vec3 d = p1 - p0, e = q1 - q0, w = q0 - p0;
  const Vec3 n = d.cross(e);
  const double n_sq = n.squaredNorm(), height = w.dot(n);
  if (n_sq <= kNearlyParallelSq * kSafety * d.squaredNorm() * e.squaredNorm()) return false;
  const double s_n = w.cross(e).dot(n), t_n = w.cross(d).dot(n);
  return std::min({s_n, n_sq - s_n, t_n, n_sq - t_n}) < 0 || height * height > kSafety * reach_sq * n_sq;
}

}  // namespace weft::collision
