#include "physics/mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace weft::mesh {
namespace {

/// Twice the signed area of the triangle a b c.
double twice_signed_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Projects the polygon along its normal, so that it is counter-clockwise. The normal is a sum of cross products over
/// all corners (Newell's method), because the polygon need not be exactly flat.
std::vector<Vec2> flatten(std::span<const Index> corners, std::span<const Vec3> positions) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return positions[corners[k % corners.size()]]; };
  const Vec3& origin = corner(0);
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) normal += (corner(k) - origin).cross(corner(k + 1) - origin);
  const Vec3 n = normal.stableNormalized();
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec2> flat;
  for (std::size_t k = 0; k < corners.size(); ++k)
    flat.emplace_back(u.dot(corner(k) - origin), v.dot(corner(k) - origin));
  return flat;
}

/// Values of `flatness` in is_ear(), tried in this order: the height of an ear, relative to its longest side, must be
/// larger. Rounding errors move corners off a straight side. An ear at such a corner has hardly any area, and later
/// repairs of the mesh (assets/mending.hpp) would remove it together with the corner.
constexpr std::array<double, 3> kMinEarHeightRatios = {1e-3, 1e-6, 0};

/// Whether corner k of the ring is an ear: it is convex, and its triangle, sides included, contains no other corner.
/// `flatness`: a height, relative to the longest side of the triangle. Another corner that is outside the triangle by
/// at most this height counts as inside. A triangle with at most this height is no ear.
bool is_ear(const std::vector<std::size_t>& ring, std::size_t k, const std::vector<Vec2>& flat, double flatness) {
  const std::size_t n = ring.size();
  const Vec2 &a = flat[ring[(k + n - 1) % n]], &b = flat[ring[k]], &c = flat[ring[(k + 1) % n]];
  const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
  const double slack = flatness * std::max({ab, bc, ca});
  if (!(twice_signed_area(a, b, c) > slack * std::max({ab, bc, ca}))) return false;
  for (const std::size_t other : ring) {
    const Vec2& p = flat[other];
    // Skip the corners of the triangle, and other corners at the same places, where the polygon touches itself.
    if (p == a || p == b || p == c) continue;
    if (twice_signed_area(a, b, p) >= -slack * ab && twice_signed_area(b, c, p) >= -slack * bc &&
        twice_signed_area(c, a, p) >= -slack * ca)
      return false;
  }
  return true;
}

/// A triangle is a needle if its height is less than this fraction of its longest side.
constexpr double kNeedleHeightRatio = 0.05;

constexpr int kMaxFlipRounds = 100;

using Corners = std::array<std::size_t, 3>;

bool is_needle(const Corners& t, const std::vector<Vec2>& flat) {
  double longest_sq = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest_sq = std::max(longest_sq, (flat[t[(k + 1) % 3]] - flat[t[k]]).squaredNorm());
  return twice_signed_area(flat[t[0]], flat[t[1]], flat[t[2]]) < kNeedleHeightRatio * longest_sq;
}

/// Whether d lies inside the circle through a, b and c (counter-clockwise), beyond rounding errors.
bool in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  constexpr double kRounding = 1e-5;  // for coordinates of single precision
  Mat3 m;
  const Vec2 p = a - d, q = b - d, r = c - d;
  m << p.x(), p.y(), p.squaredNorm(), q.x(), q.y(), q.squaredNorm(), r.x(), r.y(), r.squaredNorm();
  const double size_sq = std::max({p.squaredNorm(), q.squaredNorm(), r.squaredNorm()});
  return m.determinant() > kRounding * size_sq * size_sq;
}

/// Flips edges inside the polygon until each is locally Delaunay (Lawson, "Software for C1 Surface Interpolation",
/// 1977), in at most kMaxFlipRounds rounds. In narrow polygons with many corners, ear clipping
/// makes needles around one vertex; flips widen them.
void flip_edges(std::vector<Corners>& triangles, const std::vector<Vec2>& flat) {
  bool has_flipped = true;
  for (int round = 0; has_flipped && round < kMaxFlipRounds; ++round) {
    has_flipped = false;
    std::map<std::array<std::size_t, 2>, std::size_t> triangle_of_edge;  // directed edge to its triangle
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) triangle_of_edge[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    std::vector<char> changed(triangles.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3 && changed[t] == 0; ++k) {
        const std::size_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        const auto across = triangle_of_edge.find({b, a});
        if (across == triangle_of_edge.end() || changed[across->second] != 0 || across->second == t) continue;
        const Corners& other = triangles[across->second];
        const std::size_t d = *std::ranges::find_if(other, [&](std::size_t v) { return v != a && v != b; });
        if (!in_circle(flat[a], flat[b], flat[c], flat[d])) continue;
        const Corners one{a, d, c}, two{d, b, c};
        if (!(twice_signed_area(flat[a], flat[d], flat[c]) > 0) || !(twice_signed_area(flat[d], flat[b], flat[c]) > 0))
          continue;
        triangles[t] = one, triangles[across->second] = two;
        changed[t] = changed[across->second] = 1;
        has_flipped = true;
      }
  }
}

/// Cuts a polygon into ears. Their corners are indices into `flat`. `flatness`: as in is_ear(), in
/// the order in which the values are tried.
std::vector<Corners> clip_ears(const std::vector<Vec2>& flat, std::span<const double> flatness) {
  std::vector<std::size_t> ring(flat.size());
  for (std::size_t k = 0; k < ring.size(); ++k) ring[k] = k;
  std::vector<Corners> ears;
  std::size_t k = 0, tried = 0;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    // Each round over all corners uses the next value of `flatness`. If the last round finds no
    // ear, the polygon crosses itself or has no area: then cut corner k, so that the loop ends.
    const std::size_t round = tried / n;
    if (round < flatness.size() && !is_ear(ring, k, flat, flatness[round])) {
      k = (k + 1) % n;
      ++tried;
      continue;
    }
    ears.push_back({ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    // Skip the next corner, so that ears do not all share one vertex.
    k = (k + 1) % ring.size();
    tried = 0;
  }
  ears.push_back({ring[0], ring[1], ring[2]});
  return ears;
}

}  // namespace

void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  constexpr std::array kAnyEar{0.0};
  for (const auto& [a, b, c] : clip_ears(flatten(corners, positions), kAnyEar))
    triangles.push_back({corners[a], corners[b], corners[c]});
}

void triangulate_face(std::span<const Index> corners, std::span<const Vec3> positions,
                      std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  const std::vector<Vec2> flat = flatten(corners, positions);
  std::vector<Corners> ears = clip_ears(flat, kMinEarHeightRatios);
  if (std::ranges::any_of(ears, [&](const Corners& t) { return is_needle(t, flat); })) flip_edges(ears, flat);
  for (const auto& [a, b, c] : ears) triangles.push_back({corners[a], corners[b], corners[c]});
}

}  // namespace weft::mesh
