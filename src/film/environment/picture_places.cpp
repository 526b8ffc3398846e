#include "film/environment/picture_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <variant>

#include "core/error.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::environment {
namespace {

constexpr double kPi = std::numbers::pi;

/// Corners of a triangle in axes with z up [m], and its normal (not of unit length).
struct Corners {
  std::array<Vec3, 3> x;
  Vec3 normal;
  Vec3 middle() const { return (x[0] + x[1] + x[2]) / 3; }
};

/// Converts lengths on a surface to numbers of repetitions of the picture.
struct Tiling {
  std::optional<Vec2> tile;  // size of one repetition [m]; absent: the picture is not repeated

  /// Number of repetitions along a length [m] in the direction of `axis` (0: width, 1: height); 1 without a tile.
  double count(double length, int axis) const { return tile ? length / (*tile)[axis] : 1; }
  double whole_count(double length, int axis) const { return std::max(1.0, std::round(count(length, axis))); }
};

/// Angle of the direction (x, y) [turns]: 0 along −y, increasing toward +x. Of all equivalent values, returns the one
/// within half a turn of `near`.
double angle_in_turns(double x, double y, double near) {
  const double turn = std::atan2(x, -y) / (2 * kPi);
  return turn + std::round(near - turn);
}

/// Angles of the corners around the z axis in turns, without a jump between corners. A corner on the axis gets the
/// angle of the middle of the triangle.
std::array<double, 3> turns_around(const Corners& corners, double radius) {
  const Vec3 middle = corners.middle();
  const double at_middle = angle_in_turns(middle.x(), middle.y(), 0);
  std::array<double, 3> around{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& x = corners.x[k];
    const bool on_axis = std::hypot(x.x(), x.y()) < 1e-9 * radius;
    around[k] = on_axis ? at_middle : angle_in_turns(x.x(), x.y(), at_middle);
  }
  return around;
}

/// Picture coordinates of a triangle on the side of a box that faces the direction of the triangle's normal most
/// closely. `size`: of the box [m]. Pictures are upright on walls. On sides that face up, the top of the picture is
/// toward the back; on sides that face down, toward the front.
std::array<Vec2, 3> place_on_side(const Corners& corners, const Vec3& size, const Tiling& tiling) {
  Eigen::Index axis = 0;
  corners.normal.cwiseAbs().maxCoeff(&axis);
  const bool positive = corners.normal[axis] > 0;
  const Vec3 right = axis == 0 ? Vec3(0, positive ? 1 : -1, 0) : Vec3(axis == 1 && positive ? -1 : 1, 0, 0);
  const Vec3 up = axis == 2 ? Vec3(0, positive ? 1 : -1, 0) : Vec3(0, 0, 1);
  const double width = right.cwiseAbs().dot(size), height = up.cwiseAbs().dot(size);
  std::array<Vec2, 3> places;
  for (std::size_t k = 0; k < 3; ++k)
    places[k] = {(0.5 + right.dot(corners.x[k]) / width) * tiling.count(width, 0),
                 (0.5 + up.dot(corners.x[k]) / height) * tiling.count(height, 1)};
  return places;
}

/// Computes the picture coordinates of one triangle, for each shape.
struct PlaceOnShape {
  const Corners& corners;
  const Tiling& tiling;
  bool y_up;  ///< whether y is up in the scene; sizes of boxes are along the scene's axes

  using Places = std::array<Vec2, 3>;

  /// The width of the picture runs around the z axis at `radius` [m], its height along `length` [m]. `height`(corner):
  /// position of a corner on this length, from 0 to 1.
  template <class Height>
  Places around(double radius, double length, Height height) const {
    const double across = tiling.whole_count(2 * kPi * radius, 0), upward = tiling.count(length, 1);
    const std::array<double, 3> turn = turns_around(corners, radius);
    Places places;
    for (std::size_t k = 0; k < 3; ++k) places[k] = {(0.5 + turn[k]) * across, height(corners.x[k]) * upward};
    return places;
  }
  bool is_level() const {
    constexpr double kLevel = 1 - 1e-9;
    return std::abs(corners.normal.z()) > kLevel * corners.normal.norm();
  }

  Places operator()(const scene::Sphere& s) const {
    return around(s.radius, kPi * s.radius,
                  [&](const Vec3& x) { return 0.5 + std::asin(std::clamp(x.z() / s.radius, -1.0, 1.0)) / kPi; });
  }
  Places operator()(const scene::BoxShape& s) const {
    return place_on_side(corners, y_up ? Vec3(s.size.x(), s.size.z(), s.size.y()) : s.size, tiling);
  }
  Places operator()(const scene::Cylinder& s) const {
    if (is_level()) return place_on_side(corners, {2 * s.radius, 2 * s.radius, s.height}, tiling);
    return around(s.radius, s.height, [&](const Vec3& x) { return 0.5 + x.z() / s.height; });
  }
  Places operator()(const scene::Cone& s) const {
    if (is_level()) return place_on_side(corners, {2 * s.radius, 2 * s.radius, s.height}, tiling);
    return around(s.radius, std::hypot(s.radius, s.height), [&](const Vec3& x) { return 0.5 + x.z() / s.height; });
  }
  /// The height of the picture runs around the tube: from its inner side over the bottom to the outside, where the
  /// middle of the picture is, and over the top back to the inner side.
  Places operator()(const scene::Torus& s) const {
    const auto turn_of = [&](const Vec3& x, double near) {
      return angle_in_turns(x.z(), -(std::hypot(x.x(), x.y()) - s.radius), near);
    };
    const double at_middle = turn_of(corners.middle(), 0);
    const double upward = tiling.whole_count(2 * kPi * s.tube_radius, 1) / tiling.count(2 * kPi * s.tube_radius, 1);
    return around(s.radius, 2 * kPi * s.tube_radius,
                  [&](const Vec3& x) { return (0.5 + turn_of(x, at_middle)) * upward; });
  }
  /// The width of the picture runs along the pipe, its height around the pipe (on the inside from the front rim to the
  /// back rim). The ends and the rims of the pipe are treated as sides of a box.
  Places operator()(const scene::HalfPipe& s) const {
    const Vec3 middle = corners.middle();
    const double outside = s.radius + s.thickness,
                 radial = Vec2(middle.y(), middle.z()).dot(Vec2(corners.normal.y(), corners.normal.z()));
    const bool is_wall = std::abs(radial) > 0.5 * Vec2(middle.y(), middle.z()).norm() * corners.normal.norm();
    if (!is_wall) return place_on_side(corners, {s.length, 2 * outside, 2 * outside}, tiling);
    const double backward = radial < 0 ? 1 : -1;
    Places places;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = corners.x[k];
      places[k] = {(0.5 + x.x() / s.length) * tiling.count(s.length, 0),
                   (0.5 + backward * std::atan2(x.y(), -x.z()) / kPi) * tiling.count(kPi * s.radius, 1)};
    }
    return places;
  }
  Places operator()(const scene::Plane& s) const { return place_on_side(corners, {s.size.x(), s.size.y(), 1}, tiling); }
  Places operator()(const scene::MeshFile&) const { return {}; }
};

/// Mean length on the surface per unit of the UVs [m], from the ratio of the total areas.
double metres_per_uv(const assets::LoadedMesh& shape) {
  double area = 0, uv_area = 0;
  for (std::size_t t = 0; t < shape.uv.size(); ++t) {
    const auto& [a, b, c] = shape.mesh.topology.triangles[t];
    const auto& x = shape.mesh.positions;
    const Vec2 p = shape.uv[t][1] - shape.uv[t][0], q = shape.uv[t][2] - shape.uv[t][0];
    const double part = std::abs(p.x() * q.y() - p.y() * q.x());
    if (!std::isfinite(part)) continue;
    area += (x[b] - x[a]).cross(x[c] - x[a]).norm();
    uv_area += part;
  }
  return uv_area > 0 ? std::sqrt(area / uv_area) : 1;
}

PicturePlaces place_by_uv(const assets::LoadedMesh& shape, const std::optional<Vec2>& tile) {
  const double unit = tile ? metres_per_uv(shape) : 1;
  const Vec2 scale = tile ? Vec2(unit / tile->x(), unit / tile->y()) : Vec2(1, 1);
  PicturePlaces places;
  for (const std::array<Vec2, 3>& corners : shape.uv) {
    std::array<Vec2, 3>& place = places.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      place[k] = corners[k].allFinite() ? Vec2(corners[k].cwiseProduct(scale)) : Vec2(Vec2::Zero());
  }
  return places;
}

}  // namespace

PicturePlaces picture_places(const scene::Scene& scene, const scene::Obstacle& obstacle,
                             const assets::LoadedMesh& shape, const std::optional<Vec2>& tile) {
  if (const auto* file = std::get_if<scene::MeshFile>(&obstacle.shape)) {
    if (!shape.uv.empty()) return place_by_uv(shape, tile);
    throw Error(ExitCode::asset_unreadable,
                "{}:{}:{}: obstacle.{}: expected UVs in {}, by which look.image lies on it, got none",
                scene.file.string(), obstacle.line, obstacle.column, obstacle.name, file->path.string());
  }
  const Tiling tiling{tile};
  const bool y_up = scene.up == scene::UpAxis::y;
  PicturePlaces places;
  for (const mesh::Triangle& triangle : shape.mesh.topology.triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = shape.mesh.positions[static_cast<std::size_t>(triangle[k])];
      corners.x[k] = y_up ? Vec3(x.x(), -x.z(), x.y()) : x;
    }
    corners.normal = (corners.x[1] - corners.x[0]).cross(corners.x[2] - corners.x[0]);
    places.push_back(std::visit(PlaceOnShape{corners, tiling, y_up}, obstacle.shape));
  }
  return places;
}

}  // namespace weft::environment
