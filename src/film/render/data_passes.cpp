#include "film/render/data_passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "film/render/depth_raster.hpp"
#include "film/render/framing.hpp"
#include "film/render/seen.hpp"

namespace weft::render {
namespace {

constexpr double kRounding = 1e-6;  // motions below this are rounding errors [pixels]

/// Intersection of a ray from `eye` with the plane of a triangle (Möller and Trumbore 1997): the distance [lengths of
/// `along`], and the barycentric weights b and c of the second and third corner.
struct PlaneIntersection {
  double distance = 0, b = 0, c = 0;

  PlaneIntersection(const Vec3& eye, const Vec3& along, const std::array<Vec3, 3>& corners) {
    const Vec3 to_b = corners[1] - corners[0], to_c = corners[2] - corners[0], from = eye - corners[0];
    const Vec3 p = along.cross(to_c), q = from.cross(to_b);
    const double volume = to_b.dot(p);
    distance = to_c.dot(q) / volume;
    b = from.dot(p) / volume;
    c = along.dot(q) / volume;
  }
  template <class T>
  T blend(const T& of_a, const T& of_b, const T& of_c) const {
    return (1 - b - c) * of_a + b * of_b + c * of_c;
  }
};

/// Values of the channels at one pixel; units as in DataPasses::draw().
struct PixelValues {
  double depth = std::numeric_limits<double>::infinity();
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  Vec2 uv = Vec2::Zero(), motion = Vec2::Zero();
  double object = kNothing, part = 0, heat = 0;
};

}  // namespace

void DataPasses::find_hits(std::span<const SurfaceBuffers> surfaces, const View& view) {
  hits_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), {});
  const auto place = [&](const Eigen::Vector4d& clip) -> Eigen::Vector3f {
    return place_in_picture(clip, width_, height_).cast<float>();
  };
  std::vector<Eigen::Vector4d> clip;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    clip.clear();
    for (const Vec3& position : surfaces[s].positions()) clip.push_back(view.clip_from_world * position.homogeneous());
    const auto triangles = surfaces[s].triangles();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t];
      const auto write = [&](int index, bool covered, float nearness, float, float) {
        if (covered && nearness > hits_[index].nearness)
          hits_[index] = {nearness, static_cast<std::int32_t>(s), static_cast<std::int32_t>(t)};
      };
      clip_near({clip[a], clip[b], clip[c]}, [&](const auto& p, const auto& q, const auto& r) {
        fill_triangle(place(p), place(q), place(r), width_, height_, write);
      });
    }
  }
}

/// Position in the picture [pixels], from the lower left corner; absent if `position` is nearer than the near plane.
std::optional<Vec2> DataPasses::to_picture(const View& view, const Vec3& position) const {
  const Eigen::Vector4d clip = view.clip_from_world * position.homogeneous();
  if (clip.w() < view.near) return std::nullopt;
  return Vec2(place_in_picture(clip, width_, height_).head<2>());
}

void DataPasses::draw(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
                      const std::optional<EarlierFrame>& before, image::Layers& layers) {
  find_hits(surfaces, view);
  const auto add = [&](const char* name) { layers.channels.push_back({name, std::vector<float>(hits_.size())}); };
  const bool heated = std::ranges::any_of(surfaces, [](const SurfaceBuffers& s) { return !s.state().heat.empty(); });
  const std::size_t first = layers.channels.size();
  for (const char* name : {"depth.Z", "position.X", "position.Y", "position.Z", "normal.X", "normal.Y", "normal.Z",
                           "id.object", "id.part", "uv.U", "uv.V", "motion.X", "motion.Y"})
    add(name);
  if (heated) add("heat.V");

  // The part of each drawn triangle. make_painted_mesh() has sorted the triangles of painted surfaces by part.
  std::vector<std::vector<std::int32_t>> parts;
  for (const SurfaceBuffers& drawn : surfaces) {
    parts.push_back(drawn.surface().part_of_triangle);
    if (drawn.painted()) std::ranges::stable_sort(parts.back());
  }

  std::vector<const std::vector<Vec3>*> positions_before;
  for (const SurfaceBuffers& drawn : surfaces)
    positions_before.push_back(
        before ? find_positions(before->snapshot, drawn.surface(), drawn.state().positions.size()) : nullptr);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Vec2 here(x + 0.5, y + 0.5);
      const Vec3 along = pixel_ray(view, here.x(), here.y(), width_, height_);
      const Hit& hit = hits_[static_cast<std::size_t>(y) * width_ + x];
      PixelValues shown;
      Vec3 position_before;
      if (hit.surface >= 0) {
        const SurfaceBuffers& drawn = surfaces[hit.surface];
        const frame::Surface& surface = drawn.surface();
        const Triangle& corners = drawn.triangles()[hit.triangle];
        const Index a = corners[0], b = corners[1], c = corners[2];
        const auto positions = drawn.positions();
        const PlaneIntersection intersection(view.eye, along, {positions[a], positions[b], positions[c]});
        const auto& source = drawn.mesh().source;
        const auto blend = [&](const auto& of) {
          return intersection.blend(of[source[a]], of[source[b]], of[source[c]]);
        };
        shown.depth = intersection.distance;
        const auto& normals = drawn.mesh().normals;
        shown.normal = intersection.blend(normals[a], normals[b], normals[c]).normalized();
        const Vec3 face = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
        if (face.dot(along) > 0) shown.normal = -shown.normal;
        shown.object = kFirstSurface + hit.surface;
        if (!parts[hit.surface].empty()) shown.part = 1 + parts[hit.surface][hit.triangle];
        if (!surface.uv.empty()) shown.uv = blend(surface.uv);
        if (!drawn.state().heat.empty()) shown.heat = blend(drawn.state().heat);
        shown.position = view.eye + shown.depth * along;
        const std::vector<Vec3>* known = positions_before[hit.surface];
        position_before = known ? Vec3(blend(*known)) : shown.position;
      }
      if (floor) {
        const double depth = floor->normal.dot(floor->point - view.eye) / floor->normal.dot(along);
        if (floor->normal.dot(along) < 0 && depth > 0 && depth < std::min(shown.depth, view.far)) {
          shown = {.depth = depth, .position = view.eye + depth * along, .normal = floor->normal, .object = kFloor};
          position_before = shown.position;
        }
      }
      if (shown.object != kNothing && before)
        if (const auto there = to_picture(before->view, position_before)) shown.motion = here - *there;
      if (shown.motion.norm() < kRounding) shown.motion.setZero();  // rounding errors, which compress badly
      const double values[] = {shown.depth,      shown.position.x(), shown.position.y(), shown.position.z(),
                               shown.normal.x(), shown.normal.y(),   shown.normal.z(),   shown.object,
                               shown.part,       shown.uv.x(),       shown.uv.y(),       shown.motion.x(),
                               shown.motion.y(), shown.heat};
      const std::size_t at = static_cast<std::size_t>(height_ - 1 - y) * width_ + x;
      for (std::size_t k = first; k < layers.channels.size(); ++k)
        layers.channels[k].values[at] = static_cast<float>(values[k - first]);
    }
  }
}

}  // namespace weft::render
