#include "mesh/polygon.hpp"

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

/// True if corner k of the ring turns left and its triangle holds no other corner, its rim included.
bool is_ear(const std::vector<std::size_t>& ring, std::size_t k, const std::vector<Vec2>& flat) {
  const std::size_t n = ring.size();
  const Vec2 &a = flat[ring[(k + n - 1) % n]], &b = flat[ring[k]], &c = flat[ring[(k + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (const std::size_t other : ring) {
    const Vec2& p = flat[other];
    // The corners themselves, and copies of them where a polygon touches itself.
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  const std::vector<Vec2> flat = flattened(corners, positions);
  std::vector<std::size_t> ring(corners.size());
  for (std::size_t k = 0; k < ring.size(); ++k) ring[k] = k;
  std::size_t k = 0, tried = 0;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    // Where no corner is an ear the polygon is not simple: cut any, so as to come to an end.
    if (tried < n && !is_ear(ring, k, flat)) {
      k = (k + 1) % n;
      ++tried;
      continue;
    }
    triangles.push_back({corners[ring[(k + n - 1) % n]], corners[ring[k]], corners[ring[(k + 1) % n]]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    // Going on behind the next corner spreads the cuts; a fan of needles would come of staying.
    k = (k + 1) % ring.size();
    tried = 0;
  }
  triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
}

}  // namespace weft::mesh
