#include "physics/collision/proximity/surface_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

// If the nearest point is closer than this [m], the direction of the line to it consists of rounding errors.
constexpr double kMinDirectionLength = 1e-10;
// Scale of the offset from a point to the start of its ray [m], and length of the ray [m].
constexpr double kRayOffset = 1e-7;
constexpr double kRayLength = 1e3;

ClosestPoints closest(const Vec3& p, const Triangle& t, std::span<const Vec3> x) {
  return closest_vertex_face(p, x[t[0]], x[t[1]], x[t[2]]);
}

// Angle [rad] that a face spans around its point with these weights: at a corner, the angle of the
// face there; on an edge, π; inside the face, 2π.
double angle_at(const Triangle& t, const std::array<double, 3>& weights, std::span<const Vec3> x) {
  const auto on = [&](std::size_t c) { return weights[c] > kRoundoff; };
  const int support = on(0) + on(1) + on(2);
  if (support != 1) return support == 2 ? std::numbers::pi : 2 * std::numbers::pi;
  const std::size_t c = on(0) ? 0 : on(1) ? 1 : 2;
  const Vec3 e = x[t[(c + 1) % 3]] - x[t[c]], f = x[t[(c + 2) % 3]] - x[t[c]];
  return std::atan2(e.cross(f).norm(), e.dot(f));
}

// Weights of the corners of `face` for the point where the segment from p to q goes through the
// face; nullopt if it does not.
std::optional<std::array<double, 3>> intersect_segment(const Vec3& p, const Vec3& q, const Triangle& face,
                                                       std::span<const Vec3> x) {
  const Vec3 &t0 = x[face[0]], &t1 = x[face[1]], &t2 = x[face[2]];
  const Vec3 segment = q - p;
  // Six times the signed volumes of the tetrahedra between the segment and each edge of the face. They have the same
  // sign if the line through p and q passes through the face.
  const double v0 = segment.dot((t1 - p).cross(t2 - p)), v1 = segment.dot((t2 - p).cross(t0 - p)),
               v2 = segment.dot((t0 - p).cross(t1 - p));
  const double sum = v0 + v1 + v2;
  if (sum == 0 || std::min({v0 / sum, v1 / sum, v2 / sum}) < 0) return std::nullopt;
  const Vec3 n = (t1 - t0).cross(t2 - t0);
  if (n.dot(p - t0) * n.dot(q - t0) > 0) return std::nullopt;
  return std::array<double, 3>{v0 / sum, v1 / sum, v2 / sum};
}

struct Box {
  Vec3 low, high;
  Box(const Triangle& t, std::span<const Vec3> x)
      : low(x[t[0]].cwiseMin(x[t[1]]).cwiseMin(x[t[2]])), high(x[t[0]].cwiseMax(x[t[1]]).cwiseMax(x[t[2]])) {}
};

}  // namespace

Vec3 face_normal(const Triangle& t, std::span<const Vec3> x) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).stableNormalized();
}

SurfacePoint nearest_point(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> x) {
  SurfacePoint best;
  double best_sq = std::numeric_limits<double>::infinity();
  Vec3 difference = Vec3::Zero(), outward = Vec3::Zero();
  for (const Triangle& t : triangles) {
    const Box box(t, x);
    if ((p - p.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm() > (1 + kRoundoff) * best_sq) continue;
    const ClosestPoints points = closest(p, t, x);
    if (points.distance_sq > (1 + kRoundoff) * best_sq) continue;
    const std::array<double, 3> weights{-points.weights[1], -points.weights[2], -points.weights[3]};
    if (points.distance_sq < (1 - kRoundoff) * best_sq) {
      best.face = t;
      best.weights = weights;
      best_sq = points.distance_sq;
      difference = points.difference;
      outward.setZero();
    }
    // Skip a nearest point that is equally near but at another place, such as on the other side of a thin body.
    if ((points.difference - difference).squaredNorm() >
        kRoundoff * best_sq + kMinDirectionLength * kMinDirectionLength)
      continue;
    outward += angle_at(t, weights, x) * face_normal(t, x);
  }
  const double distance = std::sqrt(best_sq);
  const double sign = outward.dot(difference) < 0 ? -1 : 1;
  best.height = sign * distance;
  best.normal = distance > kMinDirectionLength ? Vec3(sign * difference / distance) : outward.stableNormalized();
  return best;
}

SurfacePoint nearest_point(const Vec3& p, const BroadPhase& broad_phase, std::size_t surface, std::span<const Vec3> x,
                           const Vec3& towards, const CountsFace& counts) {
  const Surface& all = broad_phase.surface(surface);
  const auto triangle = [&](Index number) -> const Triangle& { return all.triangles[number - all.first_triangle]; };
  const auto distance_sq = [&](Index number) {
    if (counts && !counts(triangle(number))) return std::numeric_limits<double>::infinity();
    return closest(p, triangle(number), x).distance_sq;
  };
  std::vector<Index> numbers;
  if (!towards.isZero())
    broad_phase.nearest_triangles(
        surface, p,
        [&](Index number) {
          const bool faces_towards = face_normal(triangle(number), x).dot(towards) > kMinFacingCosine;
          return faces_towards ? distance_sq(number) : std::numeric_limits<double>::infinity();
        },
        numbers);
  if (numbers.empty()) broad_phase.nearest_triangles(surface, p, distance_sq, numbers);
  std::vector<Triangle> nearest;
  for (const Index number : numbers) nearest.push_back(triangle(number));
  return nearest_point(p, nearest, x);
}

bool is_inside(const Vec3& p, const Vec3& towards, const BroadPhase& broad_phase, std::size_t surface,
               std::span<const Vec3> x) {
  Eigen::Index axis = 0;
  towards.cwiseAbs().maxCoeff(&axis);
  // The ray begins slightly beside p. A ray from p itself could pass through an edge or a corner and hit two faces or
  // none.
  const Vec3 from = p + kRayOffset * Vec3(0.918, 0.637, 0.781);
  Vec3 to = from;
  to[axis] += towards[axis] < 0 ? -kRayLength : kRayLength;
  const Surface& all = broad_phase.surface(surface);
  std::vector<Index> numbers;
  broad_phase.triangles_in_box(surface, from.cwiseMin(to), from.cwiseMax(to), numbers);
  int net_exits = 0;
  for (const Index number : numbers) {
    const Triangle& face = all.triangles[number - all.first_triangle];
    if (intersect_segment(from, to, face, x)) net_exits += face_normal(face, x).dot(to - from) > 0 ? 1 : -1;
  }
  return net_exits > 0;
}

std::vector<Triangle> triangles_near(const Triangle& triangle, const BroadPhase& broad_phase, std::size_t surface,
                                     std::span<const Vec3> x, double distance) {
  const Surface& all = broad_phase.surface(surface);
  const Box box(triangle, x);
  std::vector<Index> numbers;
  broad_phase.triangles_in_box(surface, box.low.array() - distance, box.high.array() + distance, numbers);
  std::vector<Triangle> near;
  for (const Index number : numbers) {
    const Triangle& other = all.triangles[number - all.first_triangle];
    const Box of_other(other, x);
    if ((box.low - of_other.high).maxCoeff() < distance && (of_other.low - box.high).maxCoeff() < distance)
      near.push_back(other);
  }
  return near;
}

std::optional<std::array<double, 3>> find_crossing(const Triangle& a, const Triangle& b, std::span<const Vec3> x) {
  std::array<double, 3> sum{0, 0, 0};
  int count = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t next = (c + 1) % 3;
    if (intersect_segment(x[a[c]], x[a[next]], b, x)) {
      // The distances of the two ends from the plane of the face give the fraction of the edge at
      // which it passes through the face.
      const Vec3 n = face_normal(b, x);
      const double from = std::abs(n.dot(x[a[c]] - x[b[0]])), to = std::abs(n.dot(x[a[next]] - x[b[0]]));
      const double fraction = from + to > 0 ? from / (from + to) : 0.5;
      sum[c] += 1 - fraction;
      sum[next] += fraction;
      ++count;
    }
    if (const auto weights = intersect_segment(x[b[c]], x[b[next]], a, x)) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += (*weights)[k];
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  for (double& weight : sum) weight /= count;
  return sum;
}

}  // namespace weft::collision
