// How much of its surroundings each point sees, drawn small and smoothed; see shaders/occlusion.frag.
#pragma once

#include "render/quality.hpp"
#include "render/shadow_maps.hpp"

namespace weft::render {

class AmbientOcclusion {
 public:
  /// For pictures of width x height pixels.
  AmbientOcclusion(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// Expects the frame block bound to 0; `draw_geometry` draws subjects and floor, `casters` the subjects alone.
  /// Leaves the result bound to unit 3.
  void draw(const SkyView& above, const SkyView& below, const DepthProgram& depth, const DrawCasters& casters,
            const DrawCasters& draw_geometry);

 private:
  void draw_sky_maps(const SkyView& above, const SkyView& below, const DepthProgram& depth, const DrawCasters& casters);

  const Gl* gl_;
  int width_, height_;
  Program geometry_, occlusion_, blur_;
  Texture depth_, normal_, sky_, openness_, smoothed_;
  Framebuffer sky_target_, geometry_target_, openness_target_, smoothed_target_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
