// Closest points of a vertex and a triangle, and of two edges, in closed form.
#pragma once

#include <algorithm>
#include <array>

#include "core/types.hpp"

namespace weft::collision {

/// If the squared sine of the angle between two edges is at most this, rounding errors of their cross product are
/// large. The solution inside the features is then refined, and the boundaries of the features are searched as well. At
/// the limit, the error without refinement is about 1e-16 / 1e-2 of the edge length.
inline constexpr double kNearlyParallelSq = 1e-4;

/// Closest points of two features that have four vertices x together: x_a = Σ (positive weights) x on side a, x_b = −Σ
/// (negative weights) x on side b.
struct ClosestPoints {
  std::array<double, 4> weights;  ///< of side a: ≥ 0, sum 1; of side b: ≤ 0, sum −1
  Vec3 difference;                ///< x_a - x_b [m]
  double distance_sq;             ///< [m²]

  /// Bit i is set if vertex i has a non-zero weight. A closest point inside a face sets three bits,
  /// inside an edge two, at a vertex one. All other weights are exactly zero, despite rounding.
  unsigned support() const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= static_cast<unsigned>(weights[i] != 0) << i;
    return bits;
  }
};

/// Point p (side a, weights[0]) against triangle t0 t1 t2 (side b, weights[1] to [3]), which may degenerate to a
/// segment or a point. The weights always describe a point of the triangle. Error of the distance, at any distance from
/// the origin: 2e-14 of the longest edge for ordinary triangles, 2e-13 for needles of any aspect ratio.
ClosestPoints closest_vertex_face(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2);

/// Segment p0 p1 (side a, weights[0] and [1]) against segment q0 q1 (side b, weights[2] and [3]). Each segment may be a
/// point. For parallel segments, returns one of the closest pairs, the same one for the same input.
ClosestPoints closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1);

/// Factor on limits in the fast tests below, far above the rounding of their products.
inline constexpr double kSafety = 1 + 1e-6;

/// Fast test before closest_vertex_face: true only if the distance certainly exceeds √max_distance_sq. The
/// test uses two lower bounds of the distance. One is the distance of p from the plane of the
/// triangle. If p lies beyond an edge, the other is the distance of p from the plane through this
/// edge perpendicular to the triangle.
inline bool is_surely_farther(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2, double max_distance_sq) {
  const Vec3 e1 = t1 - t0, e2 = t2 - t0, w = p - t0;
  const Vec3 n = e1.cross(e2);
  const double n_sq = n.squaredNorm(), height = w.dot(n);
  const double limit = kSafety * max_distance_sq * n_sq;
  if (height * height > limit) return true;
  const double b1 = w.cross(e2).dot(n), b2 = e1.cross(w).dot(n), b0 = n_sq - b1 - b2;
  const auto beyond = [&](double b, double edge_sq) { return b < 0 && b * b > limit * edge_sq; };
  return beyond(b1, e2.squaredNorm()) || beyond(b2, e1.squaredNorm()) || beyond(b0, (e2 - e1).squaredNorm());
}

/// As is_surely_farther, but for two edges. The lower bound is the distance of the two lines. False
/// for nearly parallel edges.
inline bool are_edges_surely_farther(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1,
                                     double max_distance_sq) {
  const Vec3 d = p1 - p0, e = q1 - q0;
  const Vec3 n = d.cross(e);
  const double n_sq = n.squaredNorm(), height = (q0 - p0).dot(n);
  return n_sq > kNearlyParallelSq * kSafety * d.squaredNorm() * e.squaredNorm() &&
         height * height > kSafety * max_distance_sq * n_sq;
}

/// Fast test before closest_edge_edge: true only if one of the closest points of the two lines is
/// certainly outside its edge, or these points are certainly farther apart than √max_distance_sq. False
/// for nearly parallel edges.
inline bool is_surely_not_interior(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1,
                                   double max_distance_sq) {
  const Vec3 d = p1 - p0, e = q1 - q0, w = q0 - p0;
  const Vec3 n = d.cross(e);
  const double n_sq = n.squaredNorm(), height = w.dot(n);
  if (n_sq <= kNearlyParallelSq * kSafety * d.squaredNorm() * e.squaredNorm()) return false;
  const double s_n = w.cross(e).dot(n), t_n = w.cross(d).dot(n);
  return std::min({s_n, n_sq - s_n, t_n, n_sq - t_n}) < 0 || height * height > kSafety * max_distance_sq * n_sq;
}

}  // namespace weft::collision
