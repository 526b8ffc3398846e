#include "collision/response/certificate.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "collision/proximity/gjk.hpp"

namespace weft::collision {
namespace {

Vec3 normal(const Triangle& t, std::span<const Vec3> x) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

Vec3 sum(const Triangle& t, std::span<const Vec3> x) {
  return x[t[0]] + x[t[1]] + x[t[2]];
}

}  // namespace

double gap_along(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x) {
  const auto along = [&](Index vertex) { return n.dot(x[vertex]); };
  return std::min({along(pair.a[0]), along(pair.a[1]), along(pair.a[2])}) -
         std::max({along(pair.b[0]), along(pair.b[1]), along(pair.b[2])});
}

bool separates(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return gap_along(n, pair, x_t1) >= kFloor && gap_along(n, pair, x_t0) >= kStartFloor;
}

std::optional<Vec3> find_certificate(const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  const Vec3 centres = sum(pair.a, x_t0) - sum(pair.b, x_t0);
  std::optional<Vec3> found;
  const auto try_direction = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const Vec3 n = (direction / length).cast<float>().cast<double>();
    if (separates(n, pair, x_t0, x_t1)) found = n;
    return found.has_value();
  };
  const auto facing = [&](const Vec3& n) { return n.dot(centres) < 0 ? Vec3(-n) : n; };
  if (try_direction(facing(normal(pair.a, x_t0))) || try_direction(facing(normal(pair.b, x_t0))) ||
      try_direction(centres) || try_direction(facing(normal(pair.a, x_t1))) ||
      try_direction(facing(normal(pair.b, x_t1))))
    return found;
  const auto corners = [&](const Triangle& t) { return std::array{x_t0[t[0]], x_t0[t[1]], x_t0[t[2]]}; };
  try_direction(closest_convex(corners(pair.a), corners(pair.b)).difference);
  return found;
}

ClosestFeatures closest_features(const CornerPair& pair, std::span<const Vec3> x) {
  ClosestFeatures best;
  best.points.distance_sq = std::numeric_limits<double>::infinity();
  const auto vertex_face = [&](Index v, const Triangle& t, double sign) {
    ClosestPoints points = closest_vertex_face(x[v], x[t[0]], x[t[1]], x[t[2]]);
    if (points.distance_sq >= best.points.distance_sq) return;
    points.difference *= sign;
    for (double& w : points.weights) w *= sign;
    best = {{v, t[0], t[1], t[2]}, points};
  };
  for (int i = 0; i < 3; ++i) {
    vertex_face(pair.a[i], pair.b, 1);
    vertex_face(pair.b[i], pair.a, -1);
    for (int j = 0; j < 3; ++j) {
      const std::array<Index, 4> v{pair.a[i], pair.a[(i + 1) % 3], pair.b[j], pair.b[(j + 1) % 3]};
      const ClosestPoints points = closest_edge_edge(x[v[0]], x[v[1]], x[v[2]], x[v[3]]);
      if (points.distance_sq < best.points.distance_sq) best = {v, points};
    }
  }
  return best;
}

}  // namespace weft::collision
