// What a floor that shines reflects: the subjects as they are seen from below it, drawn small.
#pragma once

#include <span>

#include "render/geometry_buffer.hpp"
#include "render/shading.hpp"
#include "render/soft_light.hpp"

namespace weft::render {

/// The view from behind the floor that shows what the floor reflects, upside down.
View mirrored(const View& view, const Floor& floor);

class Mirror {
 public:
  /// For pictures of width x height pixels, which the floor shows at half their size.
  Mirror(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// What is drawn beside the view, as the passes of the picture take it.
  struct Subjects {
    std::span<const SurfaceBuffers> surfaces;
    std::span<const DrawnMesh> meshes;
    std::span<const Shading::Material> materials;
    const SkyView& above;
    double heat_scale;
    bool painted;  ///< pictures show
  };
  /// Expects light blocks and shadow maps bound. Leaves the picture bound to unit 13, and its distances to 14; other
  /// units and the frame block are those of this picture then.
  void draw(const View& view, const FrameUniform& block, const Subjects& subjects, const LightSet& lights);

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  const Gl* gl_;
  int width_, height_;
  GeometryBuffer geometry_;
  SoftLight soft_light_;
  Shading shading_;
  Buffer frame_block_;
  Texture picture_;  // with smaller ones, for what is blurred
};

}  // namespace weft::render
