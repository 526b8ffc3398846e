// Lights in the layout of the shaders, and the part of the world that their shadow maps cover.
#pragma once

#include <array>
#include <compare>
#include <span>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/transforms.hpp"

namespace weft::render {

struct InView;

/// Further lights are ignored: each costs a shadow map.
inline constexpr int kMaxLights = 4;

/// The snapshot's lights, at most kMaxLights. If it has none, those of the look: a warm key light from above, beside
/// the camera; for the look `stage` also one from the other side.
std::vector<frame::Light> effective_lights(const frame::FrameSnapshot& snapshot, frame::Stage::Look look,
                                           const ViewAxes& camera, const Vec3& up);

/// Light configuration that selects shader variants.
struct LightSet {
  std::size_t count = 1;  ///< 1 to kMaxLights
  bool spots = false;     ///< some lights are spots
  auto operator<=>(const LightSet&) const = default;
};
LightSet light_set(std::span<const frame::Light> lights);

/// Parallel (sun) or perspective (spot) projection onto a shadow map.
struct ShadowView {
  Mat4 clip_from_world = Mat4::Identity();
  /// Width of the penumbra in texture coordinates for each unit of depth between blocker and receiver. Valid for both
  /// kinds of light: in a perspective projection, depth and blur both scale with 1/distance.
  Vec2 penumbra_uv{0, 0};
  double depth_per_metre = 1;  ///< depth buffer units per metre, at the centre of the subjects
  double texel_metres = 0;     ///< width of one texel there [m]
};

/// Fits a shadow map of `map_size` texels as tightly as possible to the casters (world space) and to what is `in_view`;
/// null: all casters.
ShadowView fit_shadow(const frame::Light& light, std::span<const Vec3> casters, const InView* in_view, const Vec3& up,
                      int map_size);

/// A parallel view from straight above that covers `bounds` and a margin of `reach` [m], for sky occlusion between
/// objects. Depth 0 to 1 covers `depth_metres`.
struct SkyView {
  Mat4 clip_from_world = Mat4::Identity();
  double depth_metres = 1;
};
SkyView fit_sky(const Box3& bounds, const Vec3& up, double reach);

/// One light in the light block of shaders/lights.glsl, std140.
struct LightUniform {
  Eigen::Matrix4f shadow_from_world;
  Eigen::Matrix4f shadow_planes_from_world;  ///< inverse transpose of the above: transforms planes
  Eigen::Vector4f toward_light;              ///< unit; w: squared distance of a spot from its target [m²]; sun: 0
  Eigen::Vector4f position;                  ///< [m]; w: cosine of half the cone angle
  Eigen::Vector4f color;   ///< linear, times intensity; w: 1 / (cosine of the fully lit cone - position.w)
  Eigen::Vector4f shadow;  ///< penumbra_uv; depth bias
};
static_assert(sizeof(LightUniform) == 2 * 64 + 4 * 16,
              "as packed in lights.glsl: five vectors would be padded to six here");
struct LightsUniform {
  std::array<LightUniform, kMaxLights> lights;
};

/// Packs a light. `scale`: factor on its intensity for each channel.
LightUniform pack_light(const frame::Light& light, const ShadowView& shadow, const Vec3& scale);

}  // namespace weft::render
