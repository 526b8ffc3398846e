#include "collision/response/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

// Gap that a certificate must show at the end of a step [m]: a hundred times where double precision begins to fail for
// coordinates of a few metres.
constexpr double kFloor = 1e-6;
// Gap that a push restores [m], or half of the gap at the start where that is less: a tenth of a fabric's thickness, so
// that the contact springs of the next step have something to act on.
constexpr double kKeep = 2e-4;
// Rounds of pushing before particles are drawn back, and before the step is given up.
constexpr int kPushRounds = 24;
constexpr int kRounds = 60;

using Corners3 = std::array<Vec3, 3>;

double lowest(const Vec3& n, const Corners3& x) {
  return std::min({n.dot(x[0]), n.dot(x[1]), n.dot(x[2])});
}
double highest(const Vec3& n, const Corners3& x) {
  return std::max({n.dot(x[0]), n.dot(x[1]), n.dot(x[2])});
}
double gap(const Vec3& n, const Corners3& a, const Corners3& b) {
  return lowest(n, a) - highest(n, b);
}

Vec3 normal(const Corners3& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]);
}

}  // namespace

ClosestFeatures closest_features(const Triangle& a, const Triangle& b, std::span<const Vec3> x) {
  const auto at = [&](Index v) -> const Vec3& { return x[static_cast<std::size_t>(v)]; };
  ClosestFeatures best;
  best.points.distance_sq = std::numeric_limits<double>::infinity();
  const auto vertex_face = [&](Index v, const Triangle& t, double sign) {
    ClosestPoints points = closest_vertex_face(at(v), at(t[0]), at(t[1]), at(t[2]));
    if (points.distance_sq >= best.points.distance_sq) return;
    points.difference *= sign;
    for (double& w : points.weights) w *= sign;
    best = {{v, t[0], t[1], t[2]}, points};
  };
  for (int i = 0; i < 3; ++i) {
    vertex_face(a[i], b, 1);
    vertex_face(b[i], a, -1);
    for (int j = 0; j < 3; ++j) {
      const std::array<Index, 4> v{a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]};
      const ClosestPoints points = closest_edge_edge(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
      if (points.distance_sq < best.points.distance_sq) best = {v, points};
    }
  }
  return best;
}

Separation::Corners Separation::corners(Index triangle, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const {
  Corners result;
  for (int k = 0; k < 3; ++k) {
    const auto vertex = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(triangle)][k]);
    result.t0[k] = x_t0[vertex];
    result.t1[k] = x_t1[vertex];
  }
  return result;
}

Vec3 Separation::direction_between(const TrianglePair& pair, std::span<const Vec3> x) const {
  return closest_features(triangles_[static_cast<std::size_t>(pair.a)], triangles_[static_cast<std::size_t>(pair.b)], x)
      .points.difference;
}

bool Separation::certified(const TrianglePair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const {
  const Corners a = corners(pair.a, x_t0, x_t1), b = corners(pair.b, x_t0, x_t1);
  const auto divides = [&](const Vec3& n) {
    const double least = kFloor * n.norm();
    return gap(n, a.t1, b.t1) >= least && gap(n, a.t0, b.t0) > 0;
  };
  // From cheap to dear. Layers are divided by a face normal, neighbours in the plane by the direction of the centres.
  const Vec3 centres = (a.t0[0] - b.t0[0]) + (a.t0[1] - b.t0[1]) + (a.t0[2] - b.t0[2]);
  const auto facing = [&](const Vec3& n) { return n.dot(centres) < 0 ? Vec3(-n) : n; };
  return divides(facing(normal(a.t0))) || divides(facing(normal(b.t0))) || divides(centres) ||
         divides(facing(normal(a.t1))) || divides(facing(normal(b.t1))) || divides(direction_between(pair, x_t0));
}

// Moves the ends of a pair apart; false if what cannot move leaves no room.
bool Separation::push_apart(const TrianglePair& pair, std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                            std::span<const std::uint8_t> movable, int round, SeparationReport& report) {
  const Corners a = corners(pair.a, x_t0, x_t1), b = corners(pair.b, x_t0, x_t1);
  const Vec3 direction = direction_between(pair, x_t0);
  const double start_gap = direction.norm();
  if (start_gap == 0) return false;
  const Vec3 n = direction / start_gap;
  const double target = std::max(2 * kFloor, std::min(kKeep, 0.5 * start_gap));

  // The dividing plane n·x = c at the end: midway, unless what cannot move stands in the way.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low = -kInfinity, high = kInfinity;  // of c
  for (int k = 0; k < 3; ++k) {
    const auto va = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(pair.a)][k]);
    const auto vb = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(pair.b)][k]);
    if (!movable[va]) high = std::min(high, n.dot(a.t1[k]) - 0.5 * target);
    if (!movable[vb]) low = std::max(low, n.dot(b.t1[k]) + 0.5 * target);
  }
  if (low > high) return false;
  const double plane = std::clamp(0.5 * (lowest(n, a.t1) + highest(n, b.t1)), low, high);

  const auto push = [&](Index triangle, double sign) {
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(triangle)][k]);
      const double missing = sign * plane + 0.5 * target - sign * n.dot(x_t1[v]);
      if (missing <= 0 || !movable[v]) continue;
      x_t1[v] += sign * missing * n;
      report.largest_push = std::max(report.largest_push, missing);
      changed_in_[v] = round;
    }
  };
  push(pair.a, 1);
  push(pair.b, -1);
  return true;
}

std::span<const TrianglePair> Separation::find_failing(std::span<const TrianglePair> pairs, std::span<const Vec3> x_t0,
                                                       std::span<const Vec3> x_t1) {
  failing_.clear();
  for (const TrianglePair& pair : pairs)
    if (!certified(pair, x_t0, x_t1)) failing_.push_back(pair);
  return failing_;
}

SeparationReport Separation::enforce(std::span<const TrianglePair> pairs, std::span<const Vec3> x_t0,
                                     std::span<Vec3> x_t1, std::span<const std::uint8_t> movable) {
  SeparationReport report;
  changed_in_.assign(x_t0.size(), 0);
  find_failing(pairs, x_t0, x_t1);
  report.corrected_pairs = static_cast<int>(failing_.size());

  for (int round = 1; !failing_.empty(); ++round) {
    if (round > kRounds) {
      report.stuck = failing_.front();
      return report;
    }
    for (const TrianglePair& pair : failing_) {
      if (round <= kPushRounds) {
        if (certified(pair, x_t0, x_t1)) continue;  // an earlier push of this round was enough
        if (push_apart(pair, x_t0, x_t1, movable, round, report)) continue;
      }
      // Halfway back to where there was no intersection.
      for (Index triangle : {pair.a, pair.b}) {
        for (Index v : triangles_[static_cast<std::size_t>(triangle)]) {
          const auto i = static_cast<std::size_t>(v);
          if (!movable[i] || changed_in_[i] == round) continue;
          const Vec3 back = 0.5 * (x_t0[i] - x_t1[i]);
          x_t1[i] += back;
          report.largest_push = std::max(report.largest_push, back.norm());
          changed_in_[i] = round;
        }
      }
    }
    failing_.clear();
    const auto touched = [&](Index triangle) {
      const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
      return std::any_of(t.begin(), t.end(),
                         [&](Index v) { return changed_in_[static_cast<std::size_t>(v)] == round; });
    };
    for (const TrianglePair& pair : pairs)
      if ((touched(pair.a) || touched(pair.b)) && !certified(pair, x_t0, x_t1)) failing_.push_back(pair);
  }
  report.separated = true;
  return report;
}

}  // namespace weft::collision
