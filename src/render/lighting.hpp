// Lights as the shaders read them, with the part of the world that their shadow maps cover.
#pragma once

#include <array>
#include <compare>
#include <span>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/transforms.hpp"

namespace weft::render {

struct InView;

/// More lights than this are left out: each costs a shadow map.
inline constexpr int kMaxLights = 4;

/// The snapshot's lights, at most kMaxLights; where it has none, those of the look: a warm key light from above, beside
/// the camera; of a stage one from the other side, too.
std::vector<frame::Light> effective_lights(const frame::FrameSnapshot& snapshot, frame::Stage::Look look,
                                           const ViewAxes& camera, const Vec3& up);

/// What shaders are compiled for.
struct LightSet {
  std::size_t count = 1;  ///< 1 to kMaxLights
  bool spots = false;     ///< some are no suns
  auto operator<=>(const LightSet&) const = default;
};
LightSet light_set(std::span<const frame::Light> lights);

/// A parallel or central projection onto a shadow map.
struct ShadowView {
  Mat4 clip_from_world = Mat4::Identity();
  Vec2 penumbra_uv{0, 0};  ///< width of the penumbra, in texture coordinates, for each unit of depth between blocker
                           ///< and receiver: the same for both kinds of light, as depth goes with 1/distance in a
                           ///< central projection, and so does the blur
  double depth_per_metre = 1;  ///< of the depth buffer, in the middle of the subjects
  double texel_metres = 0;     ///< width of one texel there
};

/// Fits a shadow map of `map_size` texels to the given casters (world space), as tightly as they allow, and to what is
/// `in_view`; where that is null, to all.
ShadowView fit_shadow(const frame::Light& light, std::span<const Vec3> casters, const InView* in_view, const Vec3& up,
                      int map_size);

/// A parallel view from straight above that covers `bounds` and `reach` metres more, for the
/// light of the sky that things take from each other. Depth 0 to 1 covers `depth_metres`.
struct SkyView {
  Mat4 clip_from_world = Mat4::Identity();
  double depth_metres = 1;
};
SkyView fit_sky(const Box3& bounds, const Vec3& up, double reach);

/// Light block of shaders/lights.glsl, std140.
struct LightUniform {
  Eigen::Matrix4f shadow_from_world;
  Eigen::Matrix4f shadow_planes_from_world;  ///< inverse transpose of the above: carries planes instead of points
  Eigen::Vector4f toward_light;              ///< unit; w: squared distance of a spot from its target [m²], of a sun 0
  Eigen::Vector4f position;                  ///< [m]; w: cosine of half the cone
  Eigen::Vector4f color;   ///< linear, times intensity; w: 1 / (cosine inside which all is lit - position.w)
  Eigen::Vector4f shadow;  ///< penumbra_uv; depth bias
};
static_assert(sizeof(LightUniform) == 2 * 64 + 4 * 16,
              "as packed in lights.glsl: five vectors would be padded to six here");
struct LightsUniform {
  std::array<LightUniform, kMaxLights> lights;
};

/// Packs a light. `scale` is of its strength, for each channel.
LightUniform pack_light(const frame::Light& light, const ShadowView& shadow, const Vec3& scale);

}  // namespace weft::render
