#include "physics/untangle/forbidden_region.hpp"

#include <algorithm>
#include <limits>

#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/proximity/surface_point.hpp"

namespace weft::untangle {
namespace {

// Offset from a face at which the constructor tests whether the front of the face is inside another shell, relative to
// the diagonal of the body's bounding box: smaller than any detail, larger than rounding errors.
constexpr double kProbeOffset = 1e-6;
// Direction of rays that count windings: nearly along an axis, so that bounding boxes of rays are
// thin; not exactly along an axis or diagonal, because rays must not hit edges of models, which
// often have these directions.
const Vec3 kRayDirection(1, 0.00137, 0.00211);

}  // namespace

ForbiddenRegion::ForbiddenRegion(const collision::BroadPhase& surfaces, std::size_t number, SurfaceKind kind,
                                 std::span<const Vec3> x)
    : surfaces_(surfaces), number_(number), kind_(kind), x_(x) {
  const collision::Surface& surface = surfaces.surface(number);
  for (const collision::Triangle& t : surface.triangles)
    for (const Index v : t) box_.extend(x[v]);
  if (kind == SurfaceKind::floor) {
    normal_ = collision::face_normal(surface.triangles.front(), x);
    place_ = x[surface.triangles.front()[0]];
    return;
  }
  const double offset = kProbeOffset * box_.diagonal().norm();
  for (const collision::Triangle& t : surface.triangles)
    is_inside_other_shell_.push_back(
        contains((x[t[0]] + x[t[1]] + x[t[2]]) / 3 + offset * collision::face_normal(t, x)));
}

ForbiddenRegion::ForbiddenRegion(const collision::BroadPhase& surfaces, std::size_t number, std::span<const Vec3> x,
                                 std::span<const std::uint8_t> on_border, std::span<const ForbiddenRegion> below)
    : surfaces_(surfaces), number_(number), kind_(SurfaceKind::layer), x_(x), on_border_(on_border) {
  const collision::Surface& surface = surfaces.surface(number);
  for (const collision::Triangle& t : surface.triangles)
    for (const Index v : t) box_.extend(x[v]);
  double outward = 0;  // area facing outward minus area facing inward [m²]
  for (const collision::Triangle& t : surface.triangles) {
    const Vec3 centre = (x[t[0]] + x[t[1]] + x[t[2]]) / 3;
    Vec3 away = (centre - box_.center()).stableNormalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (const ForbiddenRegion& body : below) {
      const Exit exit = body.find_exit(centre);
      if (std::abs(exit.height) >= nearest) continue;
      nearest = std::abs(exit.height);
      away = exit.normal;
    }
    outward += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).dot(away);
  }
  if (outward < 0) outer_sign_ = -1;
}

bool ForbiddenRegion::is_near(const Vec3& p, double distance) const {
  if (kind_ == SurfaceKind::floor) return normal_.dot(p - place_) < distance;
  return box_.squaredExteriorDistance(p) <= distance * distance;
}

// Returns where the segment from p to p + `way` crosses faces, in the order along the segment.
std::vector<ForbiddenRegion::Hit> ForbiddenRegion::find_hits(const Vec3& p, const Vec3& way) const {
  const collision::Surface& surface = surfaces_.surface(number_);
  std::vector<Index> numbers;
  surfaces_.triangles_in_box(number_, p.cwiseMin(p + way), p.cwiseMax(p + way), numbers);
  std::vector<Hit> found;
  for (const Index number : numbers) {
    const collision::Triangle& t = surface.triangles[number - surface.first_triangle];
    const Vec3 &a = x_[t[0]], &b = x_[t[1]], &c = x_[t[2]];
    const double u = way.dot((b - p).cross(c - p)), v = way.dot((c - p).cross(a - p)),
                 w = way.dot((a - p).cross(b - p));
    const bool one_side = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    if (!one_side || u + v + w == 0) continue;
    const Vec3 n = (b - a).cross(c - a);
    const double along = n.dot(way);
    if (along == 0) continue;
    const double at = n.dot(a - p) / along;
    if (at > 0 && at <= 1) found.push_back({at, along > 0 ? -outer_sign_ : outer_sign_});
  }
  std::ranges::stable_sort(found, {}, &Hit::fraction);
  return found;
}

bool ForbiddenRegion::contains(const Vec3& p) const {
  if (kind_ == SurfaceKind::floor) return normal_.dot(p - place_) < 0;
  if (kind_ == SurfaceKind::layer) return exit_of_layer(p).height < 0;
  if (!box_.contains(p)) return false;
  int turns = 0;
  for (const Hit& hit : find_hits(p, 1.01 * box_.diagonal().norm() * kRayDirection)) turns += hit.winding;
  return turns < 0;
}

// If all corners of the layer that determine its nearest point are on its border, p is beside the
// cloth, neither in front of it nor behind it, and counts as outside.
ForbiddenRegion::Exit ForbiddenRegion::exit_of_layer(const Vec3& p) const {
  const collision::SurfacePoint point = collision::nearest_point(p, surfaces_, number_, x_);
  const Vec3 place = p - point.height * point.normal;
  bool beside = true;
  for (std::size_t c = 0; c < 3; ++c)
    beside = beside && (point.weights[c] <= kRoundoff || on_border_[point.face[c]] != 0);
  if (!beside) return {place, outer_sign_ * point.normal, outer_sign_ * point.height};
  const Vec3 arm = p - place;
  return {place, arm.isZero() ? Vec3(outer_sign_ * point.normal) : arm.normalized(), arm.norm()};
}

ForbiddenRegion::Exit ForbiddenRegion::find_exit(const Vec3& p) const {
  if (kind_ == SurfaceKind::layer) return exit_of_layer(p);
  if (kind_ == SurfaceKind::floor) {
    const double height = normal_.dot(p - place_);
    return {p - height * normal_, normal_, height};
  }
  const collision::Surface& surface = surfaces_.surface(number_);
  std::vector<Index> numbers;
  surfaces_.nearest_triangles(
      number_, p,
      [&](Index number) {
        if (is_inside_other_shell_[number - surface.first_triangle]) return std::numeric_limits<double>::infinity();
        const collision::Triangle& t = surface.triangles[number - surface.first_triangle];
        return collision::closest_vertex_face(p, x_[t[0]], x_[t[1]], x_[t[2]]).distance_sq;
      },
      numbers);
  std::vector<collision::Triangle> nearest;
  for (const Index number : numbers) nearest.push_back(surface.triangles[number - surface.first_triangle]);
  collision::SurfacePoint point = collision::nearest_point(p, nearest, x_);
  const Vec3 place = p - point.height * point.normal;
  // If shells cross near p, the sign of `point.height` may be wrong, so contains() decides.
  const double side = contains(p) ? -1 : 1;
  if (side * point.height < 0) point.normal = -point.normal;
  return {place, point.normal, side * std::abs(point.height)};
}

double ForbiddenRegion::distance_out(const Vec3& p, const Vec3& d) const {
  constexpr double kNoWay = std::numeric_limits<double>::infinity();
  if (kind_ == SurfaceKind::floor) {
    const double rise = normal_.dot(d);
    return rise > 0 ? -normal_.dot(p - place_) / rise : kNoWay;
  }
  const double length = 1.01 * box_.diagonal().norm();
  const std::vector<Hit> found = find_hits(p, length * d);
  if (kind_ == SurfaceKind::layer) {
    for (const Hit& hit : found)
      if (hit.winding < 0) return length * hit.fraction;
    return kNoWay;
  }
  int depth = 0;  // number of shells that contain p: the ray leaves that many more shells than it enters
  for (const Hit& hit : found) depth -= hit.winding;
  if (depth <= 0) return kNoWay;  // the ray leaves through a hole
  for (const Hit& hit : found) {
    depth += hit.winding;
    if (depth == 0) return length * hit.fraction;
  }
  return kNoWay;
}

double ForbiddenRegion::midpoint_depth(const Vec3& p, const Vec3& q) const {
  const Vec3 middle = 0.5 * (p + q);
  return contains(middle) ? -find_exit(middle).height / (p - q).norm() : 0;
}

}  // namespace weft::untangle
