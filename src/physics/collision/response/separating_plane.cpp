#include "physics/collision/response/separating_plane.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/numerics.hpp"
#include "physics/collision/proximity/gjk.hpp"

namespace weft::collision {
namespace {

using Corners = std::array<Vec3, 3>;

Corners middle_of(const Corners& p, const Corners& q) {
  return {0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])};
}

Vec3 normal(const Corners& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]);
}

/// Corners of both sides of a pair at one time, with directions for planes.
struct Sides {
  Corners a, b;
  Vec3 normal_a = normal(a), normal_b = normal(b);
  Vec3 centres = a[0] + a[1] + a[2] - b[0] - b[1] - b[2];  // from b to a

  /// From the closest point of b to that of a; zero if they intersect.
  const Vec3& closest() {
    if (!known_closest) known_closest = closest_convex(a, b);
    return *known_closest;
  }
  std::optional<Vec3> known_closest = std::nullopt;
};

Sides sides_of(const CornerPair& pair, std::span<const Vec3> x) {
  const auto corners = [&](const Triangle& t) { return Corners{x[t[0]], x[t[1]], x[t[2]]}; };
  return {corners(pair.a), corners(pair.b)};
}

// Gap between side a and side b, for heights of their corners k = 0 to 2: min height(a, k) − max height(b, k).
template <class Height>
double least_gap(const Height& height) {
  return std::min({height(&Sides::a, 0), height(&Sides::a, 1), height(&Sides::a, 2)}) -
         std::max({height(&Sides::b, 0), height(&Sides::b, 1), height(&Sides::b, 2)});
}

double gap_along(const Vec3& n, const Sides& x) {
  return least_gap([&](Corners Sides::*side, std::size_t k) { return n.dot((x.*side)[k]); });
}

/// Searches for planes over a part of the trajectory. `end_gap`: minimum gap at the end of the part [m].
class Search {
 public:
  Search(Sides& t0, Sides& t1, double end_gap) : t0_(t0), t1_(t1), end_gap_(end_gap) {}

  std::optional<Vec3> find(PlaneKinds which, int halvings) {
    const Vec3 of_a = orient_to_side_a(t0_.normal_a), of_b = orient_to_side_a(t0_.normal_b);
    if (try_constant_direction(of_a) || try_constant_direction(of_b) || try_constant_direction(t0_.centres) ||
        try_constant_direction(orient_to_side_a(t1_.normal_a)) ||
        try_constant_direction(orient_to_side_a(t1_.normal_b)))
      return found_;
    const bool turning = which != PlaneKinds::constant;
    // Triangles that intersect at the end have no separating plane.
    if (turning && t1_.closest() == Vec3::Zero()) return std::nullopt;
    if (turning && (try_turning_direction(of_a, orient_as_at_start(t1_.normal_a, t0_.normal_a)) ||
                    try_turning_direction(of_b, orient_as_at_start(t1_.normal_b, t0_.normal_b)) ||
                    try_turning_direction(t0_.centres, t1_.centres)))
      return found_;
    if (try_constant_direction(t0_.closest()) || !turning || try_turning_direction(t0_.closest(), t1_.closest()) ||
        halvings == 0)
      return found_;
    Sides middle{middle_of(t0_.a, t1_.a), middle_of(t0_.b, t1_.b)};
    if (!Search(t0_, middle, kRoundoff).find(which, halvings - 1)) return std::nullopt;
    return Search(middle, t1_, end_gap_).find(which, halvings - 1);
  }

 private:
  Vec3 orient_to_side_a(const Vec3& n) const { return n.dot(t0_.centres) < 0 ? Vec3(-n) : n; }
  // Orients the normal of a triangle at the end in the same way as its normal at the start.
  Vec3 orient_as_at_start(const Vec3& later, const Vec3& at_start) const {
    return at_start.dot(t0_.centres) < 0 ? Vec3(-later) : later;
  }

  bool try_constant_direction(const Vec3& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const Vec3 n = rounded(direction / length);
    if (gap_along(n, t1_) >= end_gap_ && gap_along(n, t0_) >= kRoundoff) found_ = n;
    return found_.has_value();
  }

  bool try_turning_direction(const Vec3& from, const Vec3& to) {
    const double from_length = from.norm(), to_length = to.norm();
    if (!(from_length > 0) || !(to_length > 0)) return false;
    const Vec3 n_t0 = from / from_length, n_t1 = rounded(to / to_length);
    const auto crosswise = [&](Corners Sides::*side, std::size_t k) {
      return n_t0.dot((t1_.*side)[k]) + n_t1.dot((t0_.*side)[k]);
    };
    if (gap_along(n_t1, t1_) >= end_gap_ && gap_along(n_t0, t0_) >= kRoundoff && least_gap(crosswise) >= 2 * kRoundoff)
      found_ = n_t1;
    return found_.has_value();
  }

  static Vec3 rounded(const Vec3& n) { return n.cast<float>().cast<double>(); }

  Sides &t0_, &t1_;
  double end_gap_;
  std::optional<Vec3> found_;
};

}  // namespace

double gap_along(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x) {
  const auto lowest = [&](const Triangle& t) { return std::min({n.dot(x[t[0]]), n.dot(x[t[1]]), n.dot(x[t[2]])}); };
  const auto highest = [&](const Triangle& t) { return std::max({n.dot(x[t[0]]), n.dot(x[t[1]]), n.dot(x[t[2]])}); };
  return lowest(pair.a) - highest(pair.b);
}

bool separates(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return gap_along(n, pair, x_t1) >= numerics.separation.least_gap && gap_along(n, pair, x_t0) >= kRoundoff;
}

std::optional<Vec3> find_separating_plane(const CornerPair& pair, std::span<const Vec3> x_t0,
                                          std::span<const Vec3> x_t1, PlaneKinds which) {
  Sides t0 = sides_of(pair, x_t0), t1 = sides_of(pair, x_t1);
  return Search(t0, t1, numerics.separation.least_gap)
      .find(which, which == PlaneKinds::all ? numerics.repair.max_retries : 0);
}

ClosestFeatures closest_features(const CornerPair& pair, std::span<const Vec3> x) {
  ClosestFeatures best;
  best.points.distance_sq = std::numeric_limits<double>::infinity();
  const auto vertex_face = [&](Index v, const Triangle& t, double sign) {
    ClosestPoints points = closest_vertex_face(x[v], x[t[0]], x[t[1]], x[t[2]]);
    if (points.distance_sq >= best.points.distance_sq) return;
    points.difference *= sign;
    for (double& w : points.weights) w *= sign;
    best = {{v, t[0], t[1], t[2]}, points, ProximityKind::vertex_face};
  };
  for (int i = 0; i < 3; ++i) {
    vertex_face(pair.a[i], pair.b, 1);
    vertex_face(pair.b[i], pair.a, -1);
    for (int j = 0; j < 3; ++j) {
      const std::array<Index, 4> v{pair.a[i], pair.a[(i + 1) % 3], pair.b[j], pair.b[(j + 1) % 3]};
      const ClosestPoints points = closest_edge_edge(x[v[0]], x[v[1]], x[v[2]], x[v[3]]);
      if (points.distance_sq < best.points.distance_sq) best = {v, points, ProximityKind::edge_edge};
    }
  }
  return best;
}

}  // namespace weft::collision
