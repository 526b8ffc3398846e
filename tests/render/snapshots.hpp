// Small snapshots for the tests of the renderer.
#pragma once

#include <cmath>
#include <numbers>

#include "film/frame/frame_snapshot.hpp"

namespace weft::render {

/// Adds a matte surface (roughness 1). Cloth has no creases.
inline frame::Surface& add_surface(frame::FrameSnapshot& snapshot, frame::ObjectKind kind, std::vector<Vec3> positions,
                                   std::vector<std::array<Index, 3>> triangles) {
  auto surface = std::make_shared<frame::Surface>();
  surface->kind = kind;
  surface->triangles = std::move(triangles);
  surface->appearance.roughness = 1;
  if (kind == frame::ObjectKind::cloth) surface->crease_angle = 180;
  snapshot.surfaces.push_back(surface);
  snapshot.states.push_back({std::move(positions), {}});
  return *surface;
}

/// Adds a square of the given half side around `center`, facing `normal`; `across` is parallel to two of its sides.
inline frame::Surface& add_square(frame::FrameSnapshot& snapshot, frame::ObjectKind kind, const Vec3& center,
                                  const Vec3& normal, const Vec3& across, double half) {
  const Vec3 x = half * across.normalized(), y = half * normal.cross(across).normalized();
  return add_surface(snapshot, kind, {center - x - y, center + x - y, center + x + y, center - x + y},
                     {{0, 1, 2}, {0, 2, 3}});
}

/// Adds a sphere of n rings and 2 n columns. At each pole, 2 n triangles have no area.
inline frame::Surface& add_sphere(frame::FrameSnapshot& snapshot, const Vec3& center, double radius, int n) {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> triangles;
  const int columns = 2 * n;
  for (int ring = 0; ring <= n; ++ring) {
    for (int column = 0; column < columns; ++column) {
      const double a = std::numbers::pi * ring / n, b = 2 * std::numbers::pi * column / columns;
      positions.push_back(center + radius * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  }
  for (int ring = 0; ring < n; ++ring) {
    for (int column = 0; column < columns; ++column) {
      const Index a = ring * columns + column, b = ring * columns + (column + 1) % columns;
      triangles.push_back({a, a + columns, b});
      triangles.push_back({b, a + columns, b + columns});
    }
  }
  return add_surface(snapshot, frame::ObjectKind::obstacle, positions, triangles);
}

/// Adds the infinite floor z = 0.
inline frame::Surface& add_floor(frame::FrameSnapshot& snapshot) {
  frame::Surface& floor =
      add_square(snapshot, frame::ObjectKind::obstacle, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 5);
  floor.infinite_floor = true;
  return floor;
}

/// `field_of_view`: vertical [degrees].
inline frame::Camera camera_at(const Vec3& position, const Vec3& target, double field_of_view) {
  return {"test", position, target, field_of_view};
}

/// `direction`: in which the light travels.
inline frame::Light sun(const Vec3& direction) {
  frame::Light light;
  light.direction = direction;
  return light;
}

/// Stage with direct light only, so that colours can be computed by hand.
inline std::shared_ptr<frame::Stage> stage_without_sky() {
  auto stage = std::make_shared<frame::Stage>();
  stage->sky_intensity = 0;
  return stage;
}

}  // namespace weft::render
