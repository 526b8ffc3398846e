// What changes slowly over the picture (ambient occlusion, the first two lights' shares), drawn small;
// shaders/soft_light.frag.
#pragma once

#include <map>
#include <vector>

#include "render/gl/program.hpp"
#include "render/quality.hpp"
#include "render/shadow_maps.hpp"
#include "render/sky_map.hpp"
#include "render/view.hpp"

namespace weft::render {

/// Lights whose shares the small picture holds.
inline constexpr std::size_t kSoftLights = 2;

/// As shaders/soft_light.glsl packs it.
struct SoftTexel {
  float surface_open, lit[kSoftLights], distance;
};

class SoftLight {
 public:
  /// For pictures of width x height pixels.
  SoftLight(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// Expects the frame and light blocks, the shadow maps and the geometry buffer bound. Leaves the result bound to
  /// unit 3.
  void draw(std::span<const DrawnMesh> meshes, const SkyView& above, LightSet lights);

  /// Parts of the picture that hold all floor to which the small picture denies light or sky. Call after draw().
  std::vector<PixelArea> shaded_floor();

 private:
  const Gl* gl_;
  QualitySettings quality_;
  int picture_width_, picture_height_, width_, height_;
  std::map<LightSet, Program> soft_light_;  // made when first needed
  Program distances_program_, first_blur_, second_blur_;
  Texture sky_, distances_, light_, smoothed_;
  Framebuffer distances_target_, light_target_, smoothed_target_;
  VertexArray no_vertices_;
  std::vector<SkyTexel> sky_map_;
  std::vector<SoftTexel> texels_;
};

}  // namespace weft::render
