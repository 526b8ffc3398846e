// Slowly varying light, drawn at reduced size: ambient occlusion and the unshadowed fractions of the first two lights
// (shaders/soft_light.frag).
#pragma once

#include <map>
#include <vector>

#include "render/gl/program.hpp"
#include "render/quality.hpp"
#include "render/shadow_maps.hpp"
#include "render/sky_map.hpp"
#include "render/soft_blur.hpp"
#include "render/view.hpp"

namespace weft::render {

class SoftLight {
 public:
  /// For pictures of width x height pixels.
  SoftLight(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// Frame and light blocks, shadow maps and geometry buffer must be bound. Binds the result to unit 3.
  void draw(std::span<const DrawnMesh> meshes, const SkyView& above, LightSet lights);

  /// Areas of the picture that contain all floor with blocked light or sky. Call after draw().
  std::vector<PixelArea> shaded_floor() const;

 private:
  const Gl* gl_;
  QualitySettings quality_;
  int picture_width_, picture_height_, width_, height_;
  std::map<LightSet, Program> soft_light_;  // made on first use
  Program distances_program_;
  Texture sky_, distances_, light_;
  Framebuffer distances_target_, light_target_;
  VertexArray no_vertices_;
  std::vector<SkyTexel> sky_map_;
  std::vector<SoftTexel> texels_;  // of the last picture, after SoftBlur
  SoftBlur blur_;
};

}  // namespace weft::render
