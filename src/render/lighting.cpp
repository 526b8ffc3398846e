#include "render/lighting.hpp"

#include <algorithm>
#include <cmath>

#include "image/color.hpp"
#include "render/depth_raster.hpp"
#include "render/in_view.hpp"

namespace weft::render {
namespace {

// Fraction of a shadow map left free at each edge, so that penumbrae end inside it.
constexpr double kBorderFraction = 1.0 / 32;

Vec3 travel_direction(const frame::Light& light) {
  const bool spot = light.kind == frame::Light::Kind::spot;
  const Vec3 direction = spot ? Vec3(light.target - light.position) : light.direction;
  return direction.squaredNorm() > 0 ? Vec3(direction.normalized()) : Vec3(-Vec3::UnitZ());
}

double half_cone(const frame::Light& light) {
  return radians(std::clamp(light.cone_angle, 1.0, 160.0)) / 2;
}

/// Tangent of half the angular size of the light source; the minimum keeps shadow edges from being razor sharp.
double source_tangent(const frame::Light& light) {
  return std::tan(radians(std::clamp(light.softness, 0.1, 40.0)) / 2);
}

ShadowView fit_sun(const frame::Light& light, std::span<const Vec3> casters, const Vec3& up, int map_size) {
  const ViewAxes axes = view_axes(travel_direction(light), up);
  const Mat4 view = look_along(Vec3::Zero(), axes);
  Box3 bounds;
  for (const Vec3& caster : casters) bounds.extend(Vec3(view.block<3, 3>(0, 0) * caster));
  if (bounds.isEmpty()) bounds = Box3(Vec3::Constant(-0.5), Vec3::Constant(0.5));
  // A flat or tiny set of casters still needs extent across and along the light.
  const double min_size = std::max(1e-3, 1e-3 * bounds.sizes().norm());
  const Vec3 size = bounds.sizes().cwiseMax(min_size);
  const Vec3 margin(kBorderFraction * size.x(), kBorderFraction * size.y(), 0.01 * size.z());
  const Vec3 half = 0.5 * size + margin;
  const Box3 fitted(bounds.center() - half, bounds.center() + half);

  ShadowView shadow;
  shadow.clip_from_world = orthographic(fitted) * view;
  const Vec3 extent = fitted.sizes();
  shadow.penumbra_uv = source_tangent(light) * extent.z() * Vec2(1 / extent.x(), 1 / extent.y());
  shadow.depth_per_metre = 1 / extent.z();
  shadow.texel_metres = std::max(extent.x(), extent.y()) / map_size;
  return shadow;
}

ShadowView fit_spot(const frame::Light& light, std::span<const Vec3> casters, const Vec3& up, int map_size) {
  const ViewAxes axes = view_axes(travel_direction(light), up);
  double nearest = 1e30, farthest = 0;
  for (const Vec3& caster : casters) {
    const double distance = axes.forward.dot(caster - light.position);
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  const double reach = std::max((light.target - light.position).norm(), 1e-2);
  farthest = 1.01 * std::max(farthest, reach);
  // Casters beside or behind the light must not pull the near plane to zero: depth precision depends on near / far.
  const double near = std::clamp(0.99 * nearest, 0.01 * farthest, 0.9 * farthest);
  const double tangent = std::tan(half_cone(light));

  ShadowView shadow;
  shadow.clip_from_world = perspective(tangent, tangent, near, farthest) * look_along(light.position, axes);
  const double source_radius = source_tangent(light) * reach;
  const double range = (farthest - near) / (farthest * near);  // range of 1/distance between depth 0 and depth 1
  shadow.penumbra_uv.setConstant(source_radius / (2 * tangent) * range);
  shadow.depth_per_metre = 1 / (range * reach * reach);
  shadow.texel_metres = 2 * tangent * reach / map_size;
  return shadow;
}

using Box2 = Eigen::AlignedBox2d;

/// Bounds of points on a map, -1 to 1; the whole map if a point is behind the light.
Box2 extent_of(std::span<const Vec3> places, const Mat4& clip_from_world) {
  Box2 extent;
  for (const Vec3& place : places) {
    const Eigen::Vector4d clip = clip_from_world * place.homogeneous();
    if (!(clip.w() > 1e-6)) return {Vec2(-1, -1), Vec2(1, 1)};
    extent.extend(Vec2(clip.head<2>() / clip.w()));
  }
  return extent;
}

/// Bounds of what is in view on a map; triangles are clipped at the light's near plane.
Box2 extent_of(const InView& in_view, const Mat4& clip_from_world) {
  Box2 extent = extent_of(in_view.places, clip_from_world);
  for (const auto& corners : in_view.cut) {
    std::array<Eigen::Vector4d, 3> clip;
    for (int c = 0; c < 3; ++c) clip[c] = clip_from_world * corners[c].homogeneous();
    clip_near(clip, [&](const auto& a, const auto& b, const auto& c) {
      for (const auto& corner : {a, b, c}) extent.extend(Vec2(corner.template head<2>() / corner.w()));
    });
  }
  return extent;
}

/// Crops a map to the part that matters: the casters in the light, and of these what is in view. Keeps at least a
/// quarter of each side, because penumbrae of more texels would be too wide for their filter.
void crop(ShadowView& shadow, std::span<const Vec3> casters, const InView* in_view) {
  constexpr double kMargin = 0.06, kMinFraction = 0.25;
  Box2 part = extent_of(casters, shadow.clip_from_world).intersection(Box2(Vec2(-1, -1), Vec2(1, 1)));
  if (part.isEmpty()) return;
  const auto grown = [](const Box2& box, const Vec2& by) { return Box2(box.min() - by, box.max() + by); };
  if (in_view != nullptr) {
    const Vec2 min_sizes = kMinFraction * part.sizes();
    const Box2 needed = part.intersection(grown(extent_of(*in_view, shadow.clip_from_world), kMargin * part.sizes()));
    if (!needed.isEmpty()) part = grown(needed, (0.5 * (min_sizes - needed.sizes())).cwiseMax(0));
  }
  part = grown(part, kBorderFraction * part.sizes() + Vec2::Constant(1e-6));
  Mat4 cropped = Mat4::Identity();
  for (int k = 0; k < 2; ++k) {
    cropped(k, k) = 2 / part.sizes()[k];
    cropped(k, 3) = -part.center()[k] * cropped(k, k);
  }
  shadow.clip_from_world = cropped * shadow.clip_from_world;
  shadow.penumbra_uv = shadow.penumbra_uv.cwiseProduct(Vec2(cropped(0, 0), cropped(1, 1)));
  shadow.texel_metres *= 0.5 * part.sizes().maxCoeff();
}

}  // namespace

std::vector<frame::Light> effective_lights(const frame::FrameSnapshot& snapshot, frame::Stage::Look look,
                                           const ViewAxes& camera, const Vec3& up) {
  std::vector<frame::Light> lights = snapshot.lights;
  if (lights.size() > kMaxLights) lights.resize(kMaxLights);
  if (!lights.empty()) return lights;
  // Key light over the left shoulder and low: shadows fall to the right and slightly away, and folds show relief.
  const Vec3 level_forward = view_axes(camera.right.cross(-up), up).forward;
  frame::Light key;
  key.name = "key";
  key.direction = 0.9 * camera.right + 0.35 * level_forward - 0.8 * up;
  key.color = Vec3(1.0, 0.985, 0.955);
  key.softness = look == frame::Stage::Look::daylight ? 1 : 5;
  if (look != frame::Stage::Look::stage) return {key};
  frame::Light rim = key;
  rim.name = "rim";
  rim.direction = -0.8 * camera.right - 0.8 * level_forward - up;
  rim.color = Vec3(0.78, 0.88, 1.0);
  rim.intensity = 0.8;
  return {key, rim};
}

LightSet light_set(std::span<const frame::Light> lights) {
  const auto is_spot = [](const frame::Light& light) { return light.kind == frame::Light::Kind::spot; };
  return {lights.size(), std::any_of(lights.begin(), lights.end(), is_spot)};
}

ShadowView fit_shadow(const frame::Light& light, std::span<const Vec3> casters, const InView* in_view, const Vec3& up,
                      int map_size) {
  const bool spot = light.kind == frame::Light::Kind::spot;
  ShadowView shadow = spot ? fit_spot(light, casters, up, map_size) : fit_sun(light, casters, up, map_size);
  // Without `in_view`, the map of a sun already fits its casters.
  if (spot || in_view != nullptr) crop(shadow, casters, in_view);
  return shadow;
}

SkyView fit_sky(const Box3& bounds, const Vec3& up, double reach) {
  const ViewAxes axes = view_axes(-up, up.unitOrthogonal());
  const Mat4 view = look_along(Vec3::Zero(), axes);
  Box3 bounds_view;
  for (int corner = 0; corner < 8; ++corner) {
    bounds_view.extend(Vec3(view.block<3, 3>(0, 0) * bounds.corner(static_cast<Box3::CornerType>(corner))));
  }
  const Vec3 margin(reach, reach, 0.01 * reach);
  const Box3 fitted(bounds_view.min() - margin, bounds_view.max() + margin);
  return {orthographic(fitted) * view, fitted.sizes().z()};
}

LightUniform pack_light(const frame::Light& light, const ShadowView& shadow, const Vec3& scale) {
  const bool spot = light.kind == frame::Light::Kind::spot;
  const Mat4 shadow_from_world = texture_from_clip() * shadow.clip_from_world;
  LightUniform packed;
  packed.shadow_from_world = shadow_from_world.cast<float>();
  packed.shadow_planes_from_world = Mat4(shadow_from_world.inverse().transpose()).cast<float>();
  const double reach_sq = std::max((light.target - light.position).squaredNorm(), 1e-6);
  packed.toward_light << (-travel_direction(light)).cast<float>(), spot ? static_cast<float>(reach_sq) : 0.0f;
  const double outer = std::cos(half_cone(light)), inner = std::cos(0.8 * half_cone(light));
  packed.position << light.position.cast<float>(), static_cast<float>(outer);
  packed.color << (light.intensity * scale.cwiseProduct(image::linear_from_srgb(light.color))).cast<float>(),
      static_cast<float>(1 / (inner - outer));
  // A quarter of a texel for the slope that the filter cannot see, and 0.2 mm for rounding of the rasteriser.
  const double bias = (0.25 * shadow.texel_metres + 2e-4) * shadow.depth_per_metre;
  packed.shadow << shadow.penumbra_uv.cast<float>(), static_cast<float>(bias), 0.0f;
  return packed;
}

}  // namespace weft::render
