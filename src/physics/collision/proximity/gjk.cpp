#include "physics/collision/proximity/gjk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {

namespace {

/// The search ends when the upper and lower bounds of the distance differ by at most this fraction
/// of the size of both sets. The fraction is a few rounding errors.
constexpr double kTolerance = 1e-14;
/// Maximum number of rounds. Sets of a few corners need 3 to 8; for needles, rounding can keep the bounds farther apart
/// than kTolerance.
constexpr int kMaxRounds = 40;

/// A corner w of the Minkowski difference a - b: corner `a` of set a minus corner `b` of set b.
struct Support {
  std::size_t a = 0, b = 0;
  Vec3 w = Vec3::Zero();
};

/// Up to four corners of the Minkowski difference, and the point of their hull nearest to the origin.
struct Simplex {
  std::array<Support, 4> corner{};
  std::array<double, 4> weight{};
  std::size_t count = 0;
  Vec3 nearest = Vec3::Zero();

  bool has(const Support& s) const {
    return std::any_of(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const Support& c) { return c.a == s.a && c.b == s.b; });
  }

  /// Keeps only the corners with a non-zero weight.
  void shrink() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (weight[i] != 0) {
        corner[kept] = corner[i];
        weight[kept++] = weight[i];
      }
    count = kept;
  }
};

/// Index of the point that is furthest along d.
std::size_t furthest(std::span<const Vec3> points, const Vec3& d) {
  std::size_t best = 0;
  double max_along = points[0].dot(d);
  for (std::size_t i = 1; i < points.size(); ++i)
    if (const double along = points[i].dot(d); along > max_along) {
      max_along = along;
      best = i;
    }
  return best;
}

/// Finds the point of triangle i, j, k that is nearest to the origin. If its squared distance is
/// below `least_sq`, stores the point in `simplex` and its squared distance in `least_sq`.
/// closest_vertex_face also accepts needles, segments and points.
void try_face(Simplex& simplex, double& least_sq, std::size_t i, std::size_t j, std::size_t k) {
  const auto& c = simplex.corner;
  const ClosestPoints points = closest_vertex_face(Vec3::Zero(), c[i].w, c[j].w, c[k].w);
  if (!(points.distance_sq < least_sq)) return;
  least_sq = points.distance_sq;
  simplex.nearest = -points.difference;
  simplex.weight = {};
  simplex.weight[i] -= points.weights[1];
  simplex.weight[j] -= points.weights[2];
  simplex.weight[k] -= points.weights[3];
}

/// Whether the origin is inside the tetrahedron.
bool contains_origin(const Simplex& simplex) {
  const auto w = [&](std::size_t i) -> const Vec3& { return simplex.corner[i].w; };
  const auto [low, high] = std::minmax({w(1).dot(w(2).cross(w(3))), -w(0).dot(w(2).cross(w(3))),
                                        w(0).dot(w(1).cross(w(3))), -w(0).dot(w(1).cross(w(2)))});
  return low > 0 || high < 0;
}

void find_nearest(Simplex& simplex) {
  double least_sq = INFINITY;
  switch (simplex.count) {
    case 1:
      return try_face(simplex, least_sq, 0, 0, 0);
    case 2:
      return try_face(simplex, least_sq, 0, 1, 1);
    case 3:
      return try_face(simplex, least_sq, 0, 1, 2);
    default:
      if (contains_origin(simplex)) {
        simplex.nearest.setZero();
        return;
      }
      try_face(simplex, least_sq, 0, 1, 2);
      try_face(simplex, least_sq, 0, 1, 3);
      try_face(simplex, least_sq, 0, 2, 3);
      try_face(simplex, least_sq, 1, 2, 3);
  }
}

}  // namespace

Vec3 closest_convex(std::span<const Vec3> a, std::span<const Vec3> b) {
  double size = 0;
  for (const Vec3& p : a) size = std::max(size, (p - b[0]).cwiseAbs().maxCoeff());
  for (const Vec3& p : b) size = std::max(size, (p - b[0]).cwiseAbs().maxCoeff());

  Simplex simplex;
  simplex.corner[0].w = a[0] - b[0];
  simplex.count = 1;
  simplex.nearest = simplex.corner[0].w;
  Vec3 best = simplex.nearest;
  double distance = best.norm(), lower_bound = 0;
  for (int round = 0; round < kMaxRounds && distance > kTolerance * size; ++round) {
    // The corner of a - b that is lowest along the direction to the nearest point gives a lower bound of the distance.
    const Vec3 towards = simplex.nearest;
    const std::size_t i = furthest(a, -towards), j = furthest(b, towards);
    const Support next{i, j, a[i] - b[j]};
    lower_bound = std::max(lower_bound, next.w.dot(towards) / towards.norm());
    if (distance - lower_bound <= kTolerance * size || simplex.has(next)) break;
    simplex.corner[simplex.count++] = next;
    find_nearest(simplex);
    simplex.shrink();
    // In exact arithmetic, the distance decreases in each round; with rounding, it may not.
    const double reached = simplex.nearest.norm();
    if (!(reached < distance)) break;
    distance = reached;
    best = simplex.nearest;
  }
  return best;
}

}  // namespace weft::collision
