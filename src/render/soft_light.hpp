// What changes slowly over the picture (ambient occlusion, the first light's share), drawn small;
// shaders/soft_light.frag.
#pragma once

#include "render/quality.hpp"
#include "render/shadow_maps.hpp"

namespace weft::render {

class SoftLight {
 public:
  /// For pictures of width x height pixels.
  SoftLight(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// Expects the frame and light blocks, the shadow maps and the geometry buffer bound. Leaves the result bound to
  /// unit 3.
  void draw(const SkyView& above, const SkyView& below, const DepthProgram& depth, const DrawCasters& casters);

 private:
  void draw_sky_maps(const SkyView& above, const SkyView& below, const DepthProgram& depth, const DrawCasters& casters);

  const Gl* gl_;
  int width_, height_;
  Program soft_light_, blur_;
  Texture sky_, light_, smoothed_;
  Framebuffer sky_target_, light_target_, smoothed_target_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
