// Reflections in a glossy floor: a picture of the subjects from the eye mirrored at the floor, with half the width and
// height of the main picture.
#pragma once

#include <span>

#include "film/render/geometry_buffer.hpp"
#include "film/render/shading.hpp"
#include "film/render/traced_light.hpp"

namespace weft::render {

/// The view mirrored at the floor: it shows what the floor reflects, upside down.
View mirror_view(const View& view, const Floor& floor);

class Mirror {
 public:
  /// `width`, `height`: of the main picture [pixels].
  Mirror(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// The subjects, as prepared for the main passes.
  struct Subjects {
    std::span<const SurfaceBuffers> surfaces;
    std::span<const Shading::Material> materials;
    std::span<const TracedLight::Surface> traced;
    const ReflectedLight& light;
    double heat_scale;
    bool painted;  ///< whether pictures and colours of parts are shown
  };
  /// Draws the subjects from `view`, a result of mirror_view(). `block`: the frame block of this view. The light block
  /// must be bound. Binds the picture to texture unit 13 and its distances to unit 14. Afterwards, the frame block and
  /// the other texture units are bound to data of this pass.
  void draw(const View& view, const FrameUniform& block, const Subjects& subjects, const LightSet& lights);

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  const Gl* gl_;
  int width_, height_;
  GeometryBuffer geometry_;
  TracedLight traced_light_;
  Shading shading_;
  Buffer frame_block_;
  Texture picture_;  // with mip levels, for blurred reflections
  std::vector<Seen> seen_;
};

}  // namespace weft::render
