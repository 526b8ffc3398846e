// What changes slowly over the picture (ambient occlusion, the first two lights' shares), drawn small;
// shaders/soft_light.frag.
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

  /// Expects the frame and light blocks, the shadow maps and the geometry buffer bound. Leaves the result bound to
  /// unit 3.
  void draw(std::span<const DrawnMesh> meshes, const SkyView& above, LightSet lights);

  /// Parts of the picture that hold all floor to which the small picture denies light or sky. Call after draw().
  std::vector<PixelArea> shaded_floor() const;

 private:
  const Gl* gl_;
  QualitySettings quality_;
  int picture_width_, picture_height_, width_, height_;
  std::map<LightSet, Program> soft_light_;  // made when first needed
  Program distances_program_;
  Texture sky_, distances_, light_;
  Framebuffer distances_target_, light_target_;
  VertexArray no_vertices_;
  std::vector<SkyTexel> sky_map_;
  std::vector<SoftTexel> texels_;  // of the last picture, smoothed
  SoftBlur blur_;
};

}  // namespace weft::render
