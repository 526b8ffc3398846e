// Light and colour of every pixel of the geometry buffer.
#pragma once

#include <optional>
#include <span>

#include "render/geometry_buffer.hpp"
#include "render/quality.hpp"
#include "render/shadow_maps.hpp"

namespace weft::render {

class Shading {
 public:
  Shading(const Gl& gl, const QualitySettings& quality, int width, int height, const GeometryBuffer& geometry);

  /// Looks of the surfaces in the order of their materials. `heat_scale`: 1 / hottest value, 0 for the surfaces' own
  /// colours; only cloth shows heat. Expects the frame and light blocks, shadow maps, soft light and geometry bound.
  struct Material {
    frame::Appearance appearance;
    bool cloth = false;
  };
  void draw(std::span<const Material> materials, double heat_scale, std::size_t light_count);

  /// The picture in sRGB bytes, lowest row first.
  const Texture& picture() const { return picture_; }

 private:
  void upload_materials(std::span<const Material> materials, double heat_scale);

  struct Programs {
    Program cloth, solid, floor, backdrop;
    Programs(const Gl& gl, const QualitySettings& quality, bool many_lights);
  };

  const Gl* gl_;
  int width_, height_;
  QualitySettings quality_;
  std::optional<Programs> one_light_, many_lights_;  // made when first needed
  Texture picture_, heat_colors_, materials_;
  Framebuffer target_;
  VertexArray no_vertices_;
  int material_rows_ = 0;
};

}  // namespace weft::render
