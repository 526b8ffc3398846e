// Direct light without shadows, for eight points at a time, by the formulas of toward_light() in shaders/lights.glsl.
#pragma once

#include "film/render/lighting.hpp"
#include "film/render/ray_scene.hpp"

namespace weft::render {

/// Directions from eight points toward a lamp, and the relative intensity of the lamp at these
/// points. The intensity is 1 for a sun. For a spot, it is 1 at its target and 0 outside its cone.
struct LampSample {
  Lanes3 direction;  ///< unit length
  Lanes distance;    ///< distance of the lamp [m]; 1e30 for suns
  Lanes intensity;
};
inline LampSample sample_lamp(const Lamp& lamp, const Lanes3& point) {
  const LightUniform& light = lamp.packed;
  const auto all = [](float value) { return Lanes(Lanes::Constant(value)); };
  const Lanes3 axis{all(light.toward_light.x()), all(light.toward_light.y()), all(light.toward_light.z())};
  if (!lamp.is_spot()) return {axis, all(1e30f), all(1)};
  const Lanes3 way{light.position.x() - point.x, light.position.y() - point.y, light.position.z() - point.z};
  const Lanes square = dot(way, way).max(1e-6f), distance = square.sqrt();
  const Lanes3 direction = (1 / distance) * way;
  const Lanes t = ((dot(direction, axis) - light.position.w()) * light.color.w()).max(0.0f).min(1.0f);
  return {direction, distance, t * t * (3 - 2 * t) * light.toward_light.w() / square};
}

}  // namespace weft::render
