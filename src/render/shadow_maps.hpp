// Depth seen from each light, and coarse ranges of it that let most pixels do without filtering.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "render/gl/program.hpp"
#include "render/lighting.hpp"
#include "render/quality.hpp"

namespace weft::render {

/// Draws the depth of all casters with the current program's clip_from_world at the given uniform place.
using DrawCasters = std::function<void()>;

/// One program that draws depth alone.
class DepthProgram {
 public:
  explicit DepthProgram(const Gl& gl)
      : gl_(&gl), program_(gl, "depth.vert", ""), place_(program_.uniform("clip_from_world")) {}
  /// Clears the depth of the bound framebuffer and draws the casters into it.
  void draw(const Mat4& clip_from_world, const DrawCasters& casters) const;

 private:
  const Gl* gl_;
  Program program_;
  GLint place_;
};

class ShadowMaps {
 public:
  ShadowMaps(const Gl& gl, const QualitySettings& quality);

  /// Draws the map of every light and uploads the light block. Leaves the maps bound to units 0 to 2.
  void draw(std::span<const frame::Light> lights, std::span<const Vec3> caster_positions, const Vec3& up,
            const Vec3& scale, const DepthProgram& depth, const DrawCasters& casters);

  /// Lines for the shaders that include lights.glsl.
  static std::vector<std::string> defines(const QualitySettings& quality, const LightSet& lights);

 private:
  void reserve(int layers);
  void reduce(int layer);

  const Gl* gl_;
  QualitySettings quality_;
  int layers_ = 0;
  Program reduce_depth_, reduce_range_, spread_;
  Texture depth_, range_quarter_, range_, range_spread_;
  Sampler compare_, raw_;
  Framebuffer framebuffer_;
  VertexArray no_vertices_;
  Buffer light_block_;
};

}  // namespace weft::render
