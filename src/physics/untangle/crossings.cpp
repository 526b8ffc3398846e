#include "physics/untangle/crossings.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace weft::untangle {
namespace {

struct SegmentHit {
  double fraction;
  std::array<double, 3> weights;
};

// Where the segment from p to q crosses a triangle; nullopt if it does not, or if it lies in the triangle's plane.
std::optional<SegmentHit> intersect_segment(const Vec3& p, const Vec3& q, const collision::Triangle& t,
                                            std::span<const Vec3> x) {
  const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
  const Vec3 n = (b - a).cross(c - a);
  const double from = n.dot(p - a), to = n.dot(q - a);
  if (from * to > 0 || from == to) return std::nullopt;
  const Vec3 segment = q - p;
  const double u = segment.dot((b - p).cross(c - p)), v = segment.dot((c - p).cross(a - p)),
               w = segment.dot((a - p).cross(b - p));
  const double sum = u + v + w;
  if (sum == 0 || std::min({u / sum, v / sum, w / sum}) < 0) return std::nullopt;
  return SegmentHit{from / (from - to), {u / sum, v / sum, w / sum}};
}

bool is_solid(const UntangleInput& input, Index vertex) {
  const SurfaceKind kind = input.kinds[input.bodies.body_of(vertex)];
  return kind == SurfaceKind::solid || kind == SurfaceKind::floor || kind == SurfaceKind::layer;
}

}  // namespace

bool involves_solid(const UntangleInput& input, const Crossing& crossing) {
  return is_solid(input, input.edges.edges[crossing.edge].vertices[0]) ||
         is_solid(input, input.bodies.triangles()[crossing.triangle][0]);
}

CrossingFinder::CrossingFinder(const UntangleInput& input, std::span<const Vec3> x, bool self)
    : input_(input), broad_phase_(input.bodies.surfaces(), x) {
  const collision::Bodies& bodies = input.bodies;
  for (std::size_t a = 0; a < bodies.size() && bodies[a].deformable; ++a)
    for (std::size_t b = a; b < bodies.size(); ++b)
      if (self || !bodies[b].deformable) tested_body_pairs_.push_back({a, b});
}

void CrossingFinder::collect(std::span<const Vec3> x, double margin) {
  for (std::size_t b = 0; b < input_.bodies.size(); ++b) broad_phase_.refit(b, {x, x}, margin);
  candidates_.clear();
  for (const auto& [a, b] : tested_body_pairs_)
    a == b ? broad_phase_.self_pairs(a, candidates_) : broad_phase_.pairs(a, b, candidates_);
}

std::span<const collision::TrianglePair> CrossingFinder::find_near_pairs(std::span<const Vec3> x, double distance) {
  collect(x, 0.5 * distance);
  return candidates_.apart.view();
}

// Tests the edges of triangle `of_edge` against `triangle`. `without`: vertex that both share, or −1; edges that end in
// this vertex are skipped. Adds the crossings to `crossings_`. Returns whether there are any.
bool CrossingFinder::test(Index of_edge, Index triangle, Index without, std::span<const Vec3> x) {
  bool any = false;
  for (const Index e : input_.edges.of_triangle[of_edge]) {
    const auto [i, j] = input_.edges.edges[e].vertices;
    if (i == without || j == without) continue;
    const auto hit = intersect_segment(x[i], x[j], input_.bodies.triangles()[triangle], x);
    if (!hit) continue;
    any = true;
    crossings_.push_back({e, triangle, hit->fraction, hit->weights});
  }
  return any;
}

std::span<const Crossing> CrossingFinder::find(std::span<const Vec3> x) {
  collect(x, 0);
  crossings_.clear();
  pairs_ = 0;
  const auto test_pair = [&](Index a, Index b, Index shared) {
    const bool first = test(a, b, shared, x), second = test(b, a, shared, x);
    pairs_ += first || second;
  };
  for (const auto& [a, b] : candidates_.apart) test_pair(a, b, -1);
  for (const auto& [a, b] : candidates_.one_shared) {
    const auto& corners = input_.bodies.triangles()[b];
    for (const Index v : input_.bodies.triangles()[a])
      if (std::ranges::find(corners, v) != corners.end()) test_pair(a, b, v);
  }
  const auto key = [](const Crossing& c) { return std::tie(c.edge, c.triangle); };
  std::ranges::stable_sort(crossings_, {}, key);
  crossings_.erase(std::unique(crossings_.begin(), crossings_.end(),
                               [&](const Crossing& a, const Crossing& b) { return key(a) == key(b); }),
                   crossings_.end());
  return crossings_;
}

}  // namespace weft::untangle
