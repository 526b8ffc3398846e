#include "mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace weft::mesh {
namespace {

/// Twice the signed area of the triangle a b c.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The polygon seen along its normal, so that it is counter-clockwise. The normal is the sum of cross products
/// (Newell), which weighs all corners and so stands for polygons that are not quite flat.
std::vector<Vec2> flattened(std::span<const Index> corners, std::span<const Vec3> positions) {
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

/// Least ratio of the height of an ear to its longest side, tried one after the other. Corners along a straight side
/// are off it by rounding: an ear there has no area, and its corner is lost.
constexpr std::array<double, 3> kFlatness = {1e-3, 1e-6, 0};

/// True if corner k of the ring turns left and its triangle holds no other corner, its rim included. Corners nearer to
/// the rim than `flatness` times the longest side lie on it; triangles less high than that are no ears.
bool is_ear(const std::vector<std::size_t>& ring, std::size_t k, const std::vector<Vec2>& flat, double flatness) {
  const std::size_t n = ring.size();
  const Vec2 &a = flat[ring[(k + n - 1) % n]], &b = flat[ring[k]], &c = flat[ring[(k + 1) % n]];
  const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
  const double slack = flatness * std::max({ab, bc, ca});
  if (!(turn(a, b, c) > slack * std::max({ab, bc, ca}))) return false;
  for (const std::size_t other : ring) {
    const Vec2& p = flat[other];
    // The corners themselves, and copies of them where a polygon touches itself.
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= -slack * ab && turn(b, c, p) >= -slack * bc && turn(c, a, p) >= -slack * ca) return false;
  }
  return true;
}

/// A triangle less high than this ratio of its longest side is a needle.
constexpr double kNeedle = 0.05;

/// Rounds over all edges in which they are turned, at most: each edge of a strip is turned a few times.
constexpr int kMostRounds = 100;

using Corners = std::array<std::size_t, 3>;

bool is_needle(const Corners& t, const std::vector<Vec2>& flat) {
  double longest_sq = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest_sq = std::max(longest_sq, (flat[t[(k + 1) % 3]] - flat[t[k]]).squaredNorm());
  return turn(flat[t[0]], flat[t[1]], flat[t[2]]) < kNeedle * longest_sq;
}

/// Whether d lies in the circle through a, b and c by more than rounding; a b c turn left.
bool in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  constexpr double kRounding = 1e-5;  // of coordinates that were of single precision
  Mat3 m;
  const Vec2 p = a - d, q = b - d, r = c - d;
  m << p.x(), p.y(), p.squaredNorm(), q.x(), q.y(), q.squaredNorm(), r.x(), r.y(), r.squaredNorm();
  const double size_sq = std::max({p.squaredNorm(), q.squaredNorm(), r.squaredNorm()});
  return m.determinant() > kRounding * size_sq * size_sq;
}

/// Turns edges inside of the polygon until each is locally Delaunay (Lawson, "Software for C1 Surface Interpolation",
/// 1977): the fans that ears leave in narrow polygons with many corners become triangles of even size.
void turn_edges(std::vector<Corners>& triangles, const std::vector<Vec2>& flat) {
  bool turned = true;
  for (int round = 0; turned && round < kMostRounds; ++round) {
    turned = false;
    std::map<std::array<std::size_t, 2>, std::size_t> known;  // directed edge to its triangle
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) known[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    std::vector<char> changed(triangles.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3 && changed[t] == 0; ++k) {
        const std::size_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        const auto across = known.find({b, a});
        if (across == known.end() || changed[across->second] != 0 || across->second == t) continue;
        const Corners& other = triangles[across->second];
        const std::size_t d = *std::ranges::find_if(other, [&](std::size_t v) { return v != a && v != b; });
        if (!in_circle(flat[a], flat[b], flat[c], flat[d])) continue;
        const Corners one{a, d, c}, two{d, b, c};
        if (!(turn(flat[a], flat[d], flat[c]) > 0) || !(turn(flat[d], flat[b], flat[c]) > 0)) continue;
        triangles[t] = one, triangles[across->second] = two;
        changed[t] = changed[across->second] = 1;
        turned = true;
      }
  }
}

/// Ears of a polygon, by places of its corners in it. `flatness`: as kFlatness.
std::vector<Corners> clip_ears(const std::vector<Vec2>& flat, std::span<const double> flatness) {
  std::vector<std::size_t> ring(flat.size());
  for (std::size_t k = 0; k < ring.size(); ++k) ring[k] = k;
  std::vector<Corners> cut;
  std::size_t k = 0, tried = 0;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    // Each round over all corners takes flatter ears. Where no corner is an ear the polygon is not simple: cut any, so
    // as to come to an end.
    const std::size_t round = tried / n;
    if (round < flatness.size() && !is_ear(ring, k, flat, flatness[round])) {
      k = (k + 1) % n;
      ++tried;
      continue;
    }
    cut.push_back({ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    // Going on behind the next corner spreads the cuts; a fan of needles would come of staying.
    k = (k + 1) % ring.size();
    tried = 0;
  }
  cut.push_back({ring[0], ring[1], ring[2]});
  return cut;
}

}  // namespace

void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  constexpr std::array kAnyEar{0.0};
  for (const auto& [a, b, c] : clip_ears(flattened(corners, positions), kAnyEar))
    triangles.push_back({corners[a], corners[b], corners[c]});
}

void triangulate_face(std::span<const Index> corners, std::span<const Vec3> positions,
                      std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  const std::vector<Vec2> flat = flattened(corners, positions);
  std::vector<Corners> cut = clip_ears(flat, kFlatness);
  if (std::ranges::any_of(cut, [&](const Corners& t) { return is_needle(t, flat); })) turn_edges(cut, flat);
  for (const auto& [a, b, c] : cut) triangles.push_back({corners[a], corners[b], corners[c]});
}

}  // namespace weft::mesh
