#include "physics/collision/proximity/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::collision {

namespace {

/// Weights below this count as zero. So if the closest point is on an edge that two faces share, closest_vertex_face()
/// finds it on the edge for both faces, despite rounding. This rule moves the closest point by up to 1e-13 of the
/// length of an edge; rounding moves it by a few times 1e-16 of that length.
constexpr double kSnap = 1e-13;

/// Bound of two rounding errors: that of a squared distance, relative to the squared distance; and that of a distance,
/// relative to the length of an edge.
constexpr double kRounding = 2e-15;

/// Parameter in [0, 1] of the point of the segment o + t e that is closest to o + w.
double along_segment(const Vec3& e, const Vec3& w) {
  const double length_sq = e.squaredNorm();
  if (!(length_sq > 0)) return 0;
  const double t = e.dot(w) / length_sq;
  return t < kSnap ? 0 : t > 1 - kSnap ? 1 : t;
}

/// Replaces `best` by the new solution (the other parameters) if the new one is closer. If their distances differ only
/// by rounding, replaces `best` if the new solution is inside an edge (0 < `parameter` < 1), because the closest
/// point inside an edge is never farther than the ends of this edge.
void keep_closer(ClosestPoints& best, const std::array<double, 4>& weights, const Vec3& difference, double parameter) {
  const double distance_sq = difference.squaredNorm();
  const bool inner = parameter > 0 && parameter < 1;
  if (inner ? distance_sq <= best.distance_sq * (1 + kRounding) : distance_sq < best.distance_sq * (1 - kRounding))
    best = {weights, difference, distance_sq};
}

ClosestPoints infinitely_far() {
  return {{}, Vec3::Zero(), std::numeric_limits<double>::infinity()};
}

/// Chooses between the boundary solution and the interior solution of a nearly degenerate pair.
/// Chooses the interior solution only if it is closer by more than the rounding error, so that collinear
/// vertices always give the boundary solution. `length`: of the longer edge of an edge pair, or of the
/// longer one of the two edges of a face at t0 [m].
ClosestPoints choose_closer(const ClosestPoints& boundary, const ClosestPoints& inside, double length) {
  return std::sqrt(inside.distance_sq) < std::sqrt(boundary.distance_sq) - kRounding * length ? inside : boundary;
}

}  // namespace

ClosestPoints closest_vertex_face(const Vec3& p, const Vec3& t0, const Vec3& t1, const Vec3& t2) {
  // Coordinates relative to t0: their rounding does not grow with the distance from the origin.
  const Vec3 e1 = t1 - t0, e2 = t2 - t0, w = p - t0;
  const Vec3 n = e1.cross(e2);
  const double n_sq = n.squaredNorm(), sizes = e1.squaredNorm() * e2.squaredNorm();
  const double b1 = w.cross(e2).dot(n), b2 = e1.cross(w).dot(n);
  const double snap = kSnap * n_sq;
  const bool inside = n_sq > 0 && b1 > snap && b2 > snap && b1 + b2 < n_sq - snap;
  double u1 = b1 / n_sq, u2 = b2 / n_sq;
  if (inside && n_sq > kNearlyParallelSq * sizes) {
    // Project w on the normal: w - u1 e1 - u2 e2 would lose digits by cancellation.
    const Vec3 difference = n * (w.dot(n) / n_sq);
    return {{1, -(1 - u1 - u2), -u1, -u2}, difference, difference.squaredNorm()};
  }

  ClosestPoints best = infinitely_far();
  const Vec3 e12 = t2 - t1, w1 = p - t1;
  const double s01 = along_segment(e1, w), s12 = along_segment(e12, w1), s02 = along_segment(e2, w);
  keep_closer(best, {1, -(1 - s01), -s01, 0}, w - s01 * e1, s01);
  keep_closer(best, {1, 0, -(1 - s12), -s12}, w1 - s12 * e12, s12);
  keep_closer(best, {1, -(1 - s02), 0, -s02}, w - s02 * e2, s02);
  if (!inside) return best;

  // The triangle is a needle, so u1 and u2 have large rounding errors. Correct them by the solution for the residual
  // `rest`.
  const Vec3 rest = w - u1 * e1 - u2 * e2;
  u1 = std::clamp(u1 + rest.cross(e2).dot(n) / n_sq, 0.0, 1.0);
  u2 = std::clamp(u2 + e1.cross(rest).dot(n) / n_sq, 0.0, 1 - u1);
  const Vec3 difference = w - u1 * e1 - u2 * e2;
  const ClosestPoints refined{{1, -(1 - u1 - u2), -u1, -u2}, difference, difference.squaredNorm()};
  return choose_closer(best, refined, std::sqrt(std::max(e1.squaredNorm(), e2.squaredNorm())));
}

ClosestPoints closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 d = p1 - p0, e = q1 - q0, w = q0 - p0;
  const Vec3 n = d.cross(e);
  const double n_sq = n.squaredNorm(), sizes = d.squaredNorm() * e.squaredNorm();
  const double s_n = w.cross(e).dot(n), t_n = w.cross(d).dot(n);
  const double snap = kSnap * n_sq;
  const bool inside = n_sq > 0 && s_n > snap && s_n < n_sq - snap && t_n > snap && t_n < n_sq - snap;
  double s = s_n / n_sq, t = t_n / n_sq;
  if (inside && n_sq > kNearlyParallelSq * sizes) {
    const Vec3 difference = n * (-w.dot(n) / n_sq);
    return {{1 - s, s, -(1 - t), -t}, difference, difference.squaredNorm()};
  }

  // The distance is a convex function of s and t. Without an interior minimum, s or t is 0 or 1.
  ClosestPoints best = infinitely_far();
  const Vec3 w_p1 = p1 - q0, w_q1 = q1 - p0;
  const double t_p0 = along_segment(e, -w), t_p1 = along_segment(e, w_p1);
  const double s_q0 = along_segment(d, w), s_q1 = along_segment(d, w_q1);
  keep_closer(best, {1, 0, -(1 - t_p0), -t_p0}, -w - t_p0 * e, t_p0);
  keep_closer(best, {0, 1, -(1 - t_p1), -t_p1}, w_p1 - t_p1 * e, t_p1);
  keep_closer(best, {1 - s_q0, s_q0, -1, 0}, s_q0 * d - w, s_q0);
  keep_closer(best, {1 - s_q1, s_q1, 0, -1}, s_q1 * d - w_q1, s_q1);
  if (!inside) return best;

  // The edges are nearly parallel, so s and t have large rounding errors. Correct them as in closest_vertex_face().
  const Vec3 rest = w + t * e - s * d;
  s = std::clamp(s + rest.cross(e).dot(n) / n_sq, 0.0, 1.0);
  t = std::clamp(t + rest.cross(d).dot(n) / n_sq, 0.0, 1.0);
  const Vec3 difference = s * d - w - t * e;
  const ClosestPoints refined{{1 - s, s, -(1 - t), -t}, difference, difference.squaredNorm()};
  return choose_closer(best, refined, std::sqrt(std::max(d.squaredNorm(), e.squaredNorm())));
}

}  // namespace weft::collision
