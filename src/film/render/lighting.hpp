// The lights of a picture, and their layout in shaders.
#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <span>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/transforms.hpp"

namespace weft::render {

using frame::kMaxLights;

/// The first kMaxLights lights of the snapshot. If the snapshot has none: the lights of the look. All looks have a warm
/// key light from the left, from above and from behind the camera. The look `stage` also has a rim light from the
/// right, from above and from behind the subjects.
std::vector<frame::Light> effective_lights(const frame::FrameSnapshot& snapshot, frame::Stage::Look look,
                                           const ViewAxes& camera, const Vec3& up);

/// Light configuration that selects shader variants.
struct LightSet {
  std::size_t count = 1;  ///< 1 to kMaxLights
  bool spots = false;     ///< some lights are spots
  auto operator<=>(const LightSet&) const = default;
};
LightSet light_set(std::span<const frame::Light> lights);

/// One light of the light block of shaders/lights.glsl, in the layout std140.
struct LightUniform {
  Eigen::Vector4f toward_light;  ///< unit; w: squared distance of a spot from its target [m²]; sun: 0
  Eigen::Vector4f position;      ///< [m]; w: cosine of half the cone angle
  Eigen::Vector4f color;         ///< linear, times intensity; w: 1 / (cosine of half the fully lit angle - position.w)
};
static_assert(sizeof(LightUniform) == 3 * 16);
struct LightsUniform {
  std::array<LightUniform, kMaxLights> lights;
};

/// A light, prepared for shaders and rays.
struct Lamp {
  LightUniform packed;
  /// Tangent of half the angular width of the source (for a spot: as seen from its target).
  float source_tangent = 0;

  bool is_spot() const { return packed.toward_light.w() != 0; }
  /// Distance of a spot from its target [m].
  float target_distance() const { return std::sqrt(packed.toward_light.w()); }
};

/// Converts a light. `scale`: factor on the intensity for each channel.
Lamp make_lamp(const frame::Light& light, const Vec3& scale);

}  // namespace weft::render
