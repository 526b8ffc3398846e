#include "film/render/view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/image/color.hpp"
#include "film/render/shading.hpp"

namespace weft::render {
namespace {

// Ratio of the light from below to the light of open floor. It is below 1, because far floor fades into a darker
// backdrop.
constexpr double kGroundLight = 0.8;
// Factor on the light from below in reflections. It is below 1, because the floor near glossy surfaces is often shaded.
constexpr double kReflectedGround = 0.5;
constexpr double kMaxGain = 1.8;           // limit on the increase of direct light; darker scenes stay dark
constexpr double kMaxWhiteBalance = 0.08;  // limit on the relative change of a channel by the white balance

/// Map from the world to picture coordinates, computed from the corners of a triangle in both.
Eigen::Matrix<double, 2, 4> picture_from_world(const std::array<Vec3, 3>& x, const std::array<Vec2, 3>& places) {
  const Vec3 p = x[1] - x[0], q = x[2] - x[0];
  Mat3 axes;
  axes << p, q, p.cross(q);
  Eigen::Matrix<double, 2, 3> changes;
  changes << places[1] - places[0], places[2] - places[0], Vec2::Zero();
  Eigen::Matrix<double, 2, 4> map;
  map.leftCols<3>() = changes * axes.inverse();
  map.col(3) = places[0] - map.leftCols<3>() * x[0];
  return map;
}

}  // namespace

std::optional<Floor> find_floor(const frame::FrameSnapshot& snapshot, const Vec3& up, bool plain) {
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    const frame::Surface& surface = *snapshot.surfaces[i];
    const auto& positions = snapshot.states[i].positions;
    if (!surface.visible || !surface.infinite_floor || positions.empty()) continue;
    Floor floor{positions.front(), up, surface.appearance};
    if (plain) floor.look.color = clay(surface.appearance).color;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      const Vec3 normal = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
      if (normal.squaredNorm() > 0) {
        floor.normal = normal.dot(up) < 0 ? -normal.normalized() : normal.normalized();
        if (floor.look.paint.texture && t < surface.paint_uv.size())
          floor.picture_from_world =
              picture_from_world({positions[a], positions[b], positions[c]}, surface.paint_uv[t]);
        break;
      }
    }
    return floor;
  }
  return std::nullopt;
}

View make_view(const frame::Camera& camera, const Vec3& up, double aspect, const Box3& subjects,
               const std::optional<Floor>& floor) {
  View view;
  view.eye = camera.position;
  view.axes = view_axes(camera.target - camera.position, up);
  // The limits are beyond all usual lenses; a spline through the keys of a zoom may reach beyond them.
  view.tan_half_height = std::tan(std::clamp(camera.field_of_view, 0.01, 179.0) * std::numbers::pi / 360);
  view.tan_half_width = view.tan_half_height * aspect;

  const double radius = 0.5 * subjects.diagonal().norm();
  const double reach = (subjects.center() - view.eye).norm() + radius;
  double nearest = view.axes.forward.dot(subjects.center() - view.eye) - radius;
  if (floor) {
    // `widest`: length of the longest ray of the picture that advances one metre along the view axis. No visible floor
    // is nearer along this axis than the height of the eye / `widest`.
    const double height = floor->normal.dot(view.eye - floor->point);
    const double widest = std::hypot(1.0, view.tan_half_width, view.tan_half_height);
    if (height > 0) nearest = std::min(nearest, height / widest);
  }
  // If the eye is close to the subjects, `nearest` may be negative. `near` is then a fraction of the scene's size, but
  // at most kClosest [m], so that the near plane of a large scene does not cut close cloth.
  constexpr double kClosest = 0.01;
  view.near = std::max(0.8 * nearest, std::min(1e-3 * reach, kClosest));
  view.far = 200 * reach;
  view.view_from_world = look_along(view.eye, view.axes);
  view.clip_from_world = perspective(view.tan_half_width, view.tan_half_height, view.near) * view.view_from_world;
  return view;
}

PixelArea visible_area(const View& view, std::span<const Vec3> points, int width, int height) {
  Eigen::AlignedBox2d seen;
  for (const Vec3& point : points) {
    const Eigen::Vector4d clip = view.clip_from_world * point.homogeneous();
    if (clip.w() < view.near) return {0, 0, width, height};
    seen.extend(Vec2(clip.head<2>() / clip.w()));
  }
  if (seen.isEmpty()) return {};
  const auto pixel = [](double ndc, int size, double margin) {
    return static_cast<int>(std::clamp((0.5 + 0.5 * ndc) * size + margin, 0.0, static_cast<double>(size)));
  };
  PixelArea area{pixel(seen.min().x(), width, -1), pixel(seen.min().y(), height, -1), 0, 0};
  area.width = pixel(seen.max().x(), width, 2) - area.x;
  area.height = pixel(seen.max().y(), height, 2) - area.y;
  return area;
}

bool fades_steeply(const View& view, const std::optional<Floor>& floor, const Box3& surroundings, int height,
                   int cell) {
  if (!floor) return false;
  // A ray that descends by `slope` per metre hits the floor at the distance eye_height / slope. The floor fades into
  // the backdrop from 1.5 radii on.
  const double radius = 0.5 * surroundings.diagonal().norm();
  const double eye_height = floor->normal.dot(view.eye - floor->point);
  if (eye_height <= 0) return false;
  double least_slope = 1;
  for (const double x : {-view.tan_half_width, view.tan_half_width})
    for (const double y : {-view.tan_half_height, view.tan_half_height})
      least_slope =
          std::min(least_slope, -floor->normal.dot(view.axes.forward + x * view.axes.right + y * view.axes.up));
  if (least_slope > eye_height / (1.5 * radius)) return false;
  // If slope * radius / eye_height changes by 0.06 over a cell, linear interpolation of the fraction of backdrop has an
  // error of 0.025: one level of 255 if floor and backdrop differ by 40 levels.
  constexpr double kMaxChange = 0.06;
  return cell * 2 * view.tan_half_height / height * radius > kMaxChange * eye_height;
}

Exposure expose(const Style& style, const std::optional<Floor>& floor, std::span<const frame::Light> lights) {
  const double direct_fraction = 1 - style.sky_intensity;
  const Vec3 sky = style.sky_intensity * style.sky_color;
  if (!floor) return {Vec3::Constant(direct_fraction), 0.8 * style.sky_color};
  Vec3 direct = Vec3::Zero();
  for (const frame::Light& each : lights) {
    // Ignores spots, because distant floor does not receive their light.
    if (each.kind != frame::Light::Kind::sun || each.direction.squaredNorm() == 0) continue;
    const double facing = std::max(0.0, -each.direction.normalized().dot(floor->normal));
    direct += direct_fraction * each.intensity * facing * image::linear_from_srgb(each.color);
  }
  Vec3 gain = Vec3::Ones();
  if (style.exposes) {
    const Vec3 missing = (Vec3::Ones() - sky).cwiseQuotient(direct.cwiseMax(1e-6));
    const double level = kLuminance.dot(Vec3::Ones() - sky) / std::max(kLuminance.dot(direct), 1e-6);
    const Vec3 tint = (missing / std::max(level, 1e-6)).cwiseMax(1 - kMaxWhiteBalance).cwiseMin(1 + kMaxWhiteBalance);
    gain = std::clamp(level, 1.0, kMaxGain) * tint;
  }
  return {direct_fraction * gain,
          image::linear_from_srgb(floor->look.color).cwiseProduct(sky + gain.cwiseProduct(direct))};
}

Lighting make_lighting(const frame::Stage& stage, const Vec3& up, const std::optional<Floor>& floor,
                       std::span<const frame::Light> lights) {
  Lighting lighting;
  lighting.style = style_of(stage);
  lighting.exposure = expose(lighting.style, floor, lights);
  lighting.gain = std::exp2(stage.exposure);
  // The light from below is that of open floor. ReflectedLight subtracts the light that shaded floor lacks.
  const Vec3 ground =
      floor && !stage.ground_color
          ? Vec3(kGroundLight * lighting.style.floor_tint * lighting.exposure.floor)
          : lighting.style.sky_intensity *
                (stage.ground_color ? image::linear_from_srgb(*stage.ground_color) : Vec3(Vec3::Constant(0.55)));
  lighting.around = make_surroundings(lighting.style, stage, up, lights, ground);
  return lighting;
}

double floor_roughness(const Style& style, const std::optional<Floor>& floor) {
  constexpr double kMatte = 1;
  if (!floor || floor->look.roughness >= kMatte) return kMatte;
  return std::min(floor->look.roughness, style.floor_roughness);
}

FrameUniform pack_frame(const View& view, const Lighting& lighting, const Box3& scene_bounds,
                        const std::optional<Floor>& floor, int width, int height) {
  const auto four = [](const Vec3& v, double w) {
    return Eigen::Vector4f(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
                           static_cast<float>(w));
  };
  const Style& style = lighting.style;
  const Surroundings& around = lighting.around;
  const double radius = 0.5 * scene_bounds.diagonal().norm();
  const bool sky = style.horizon.minCoeff() < style.horizon.maxCoeff();
  const Vec3 shown = style.floor_tint * lighting.exposure.floor;
  // If Style::horizon is coloured, the backdrop has the colours of the style. If it is grey, these
  // colours are factors on the colour of open floor.
  const auto behind = [&](const Vec3& color) -> Vec3 { return sky ? color : shown.cwiseProduct(color); };

  FrameUniform frame;
  frame.clip_from_world = view.clip_from_world.cast<float>();
  frame.view_from_world = view.view_from_world.cast<float>();
  frame.eye_world = four(view.eye, radius);
  frame.center_world = four(scene_bounds.center(), floor_roughness(style, floor));
  frame.up_world = four(around.up, 0);
  frame.right_world = four(view.axes.right, 0);
  frame.sky = four(around.sky, 0);
  frame.horizon = four(around.horizon, style.toe);
  frame.ground = four(kReflectedGround * around.ground, 0);
  frame.backdrop = four(behind(style.horizon), style.glow);
  frame.backdrop_top = four(behind(style.zenith), 0);
  frame.viewport = {static_cast<float>(width), static_cast<float>(height), 1.0f / static_cast<float>(width),
                    1.0f / static_cast<float>(height)};
  frame.frustum = {static_cast<float>(view.tan_half_width), static_cast<float>(view.tan_half_height),
                   static_cast<float>(view.near), 0};
  if (floor) {
    frame.floor_plane_world = four(floor->normal, floor->normal.dot(view.eye - floor->point));
    frame.floor_look = four(style.floor_tint * image::linear_from_srgb(floor->look.color), lighting.gain);
  } else {
    frame.floor_plane_world = Eigen::Vector4f::Zero();
    frame.floor_look = four(Vec3::Zero(), lighting.gain);
  }
  for (int i = 0; i < Surroundings::kBoxes; ++i) {
    frame.box_axes[i] = four(around.boxes[i].axis, around.boxes[i].sharpness);
    frame.box_lights[i] = four(around.boxes[i].light, 0);
  }
  const Irradiance irradiance = irradiance_of(around);
  for (std::size_t i = 0; i < irradiance.size(); ++i) frame.irradiance[i] = four(irradiance[i], 0);
  return frame;
}

}  // namespace weft::render
