#include "film/render/lighting.hpp"

#include <algorithm>
#include <cmath>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

Vec3 travel_direction(const frame::Light& light) {
  const bool spot = light.kind == frame::Light::Kind::spot;
  const Vec3 direction = spot ? Vec3(light.target - light.position) : light.direction;
  return direction.squaredNorm() > 0 ? Vec3(direction.normalized()) : Vec3(-Vec3::UnitZ());
}

double half_cone(const frame::Light& light) {
  return radians(std::clamp(light.cone_angle, 1.0, 170.0)) / 2;
}

/// Tangent of half the angular width of the light source. The lower limit of 0.1 degrees avoids shadows without
/// penumbra.
double source_tangent(const frame::Light& light) {
  return std::tan(radians(std::clamp(light.softness, 0.1, 40.0)) / 2);
}

}  // namespace

std::vector<frame::Light> effective_lights(const frame::FrameSnapshot& snapshot, frame::Stage::Look look,
                                           const ViewAxes& camera, const Vec3& up) {
  std::vector<frame::Light> lights = snapshot.lights;
  if (lights.size() > kMaxLights) lights.resize(kMaxLights);
  if (!lights.empty()) return lights;
  // The key light comes from behind the left shoulder of the viewer, 40 degrees above the horizon. Thus shadows fall to
  // the right and slightly away from the viewer, and make the shape of folds visible.
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

Lamp make_lamp(const frame::Light& light, const Vec3& scale) {
  const bool spot = light.kind == frame::Light::Kind::spot;
  const double target_distance_sq = std::max((light.target - light.position).squaredNorm(), 1e-6);
  const double outer = std::cos(half_cone(light)), inner = std::cos(0.8 * half_cone(light));
  LightUniform packed;
  packed.toward_light << (-travel_direction(light)).cast<float>(), spot ? static_cast<float>(target_distance_sq) : 0.0f;
  packed.position << light.position.cast<float>(), static_cast<float>(outer);
  packed.color << (light.intensity * scale.cwiseProduct(image::linear_from_srgb(light.color))).cast<float>(),
      static_cast<float>(1 / (inner - outer));
  return {packed, static_cast<float>(source_tangent(light))};
}

}  // namespace weft::render
