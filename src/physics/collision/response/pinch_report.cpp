#include "physics/collision/response/pinch_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/collision/proximity/surface_point.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::collision {
namespace {

constexpr double kNoFaces = std::numeric_limits<double>::infinity();

// Distance [m] from `place` to the nearest face of the obstacle with a normal within 60° of `direction`. If there is no
// such face: the distance to the nearest face of all, or infinite if that face points away from `direction`.
double distance_facing(const Vec3& place, const Vec3& direction, const BroadPhase& surfaces, std::size_t obstacle,
                       std::span<const Vec3> x) {
  const SurfacePoint point = nearest_point(place, surfaces, obstacle, x, direction);
  const bool faces = mesh::area_vector(point.face, x).dot(direction) > 0;
  return faces ? std::abs(point.height) : kNoFaces;
}

// The obstacle that presses the cloth into key.body: the nearest other obstacle, or key.body if two parts of it pinch
// the cloth.
std::optional<std::size_t> find_pressing_obstacle(const PinchedPairs& pinched, const PinchedPairs::Key& key,
                                                  const Vec3& place, const Bodies& bodies, const BroadPhase& surfaces,
                                                  std::span<const Vec3> x) {
  std::optional<std::size_t> other;
  double nearest = kNoFaces;
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    if (!pinched.is_obstacle(surfaces.surface(b)) || b == key.body) continue;
    const double distance = std::abs(nearest_point(place, surfaces, b, x).height);
    if (distance < nearest) nearest = distance, other = b;
  }
  if (bodies[key.body].rigid) return other;
  // Two parts of one deforming body, such as arm and torso, can pinch cloth. In that case, the body
  // has faces on both sides of the cloth, and on either side its nearest face is closer than any
  // other obstacle.
  const Vec3 up = mesh::area_vector(key.cloth, x).normalized();
  const double far =
      std::max(distance_facing(place, up, surfaces, key.body, x), distance_facing(place, -up, surfaces, key.body, x));
  return far < nearest ? key.body : other;
}

}  // namespace

std::vector<Pinch> list_pinches(const PinchedPairs& pinched, const Bodies& bodies, const BroadPhase& surfaces,
                                std::span<const Vec3> x) {
  std::vector<Pinch> found;
  for (const auto& [key, origin] : pinched.origins()) {
    const std::size_t cloth = pinched.body_of(key.cloth[0]), obstacle = key.body;
    const auto same = [&](const Pinch& p) { return p.cloth == cloth && p.obstacle == obstacle; };
    if (std::ranges::any_of(found, same)) continue;
    const Vec3& place = x[key.cloth[0]];
    found.push_back({cloth, obstacle, find_pressing_obstacle(pinched, key, place, bodies, surfaces, x), place});
  }
  return found;
}

std::optional<CornerPair> find_new_pinch(const PinchedPairs& pinched, const PinchedPairs& before) {
  for (const auto& [key, origin] : pinched.origins()) {
    const std::size_t cloth = pinched.body_of(key.cloth[0]), obstacle = key.body;
    const auto same = [&](const auto& other) {
      return before.body_of(other.first.cloth[0]) == cloth && other.first.body == obstacle;
    };
    if (std::ranges::none_of(before.origins(), same)) return CornerPair{key.cloth, origin.faces.front()};
  }
  return std::nullopt;
}

}  // namespace weft::collision
