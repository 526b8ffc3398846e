// Antialiasing: the geometry once more with several samples a pixel, coloured from the shaded picture.
#pragma once

#include <span>

#include "render/gl/program.hpp"
#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

class Outlines {
 public:
  Outlines(const Gl& gl, int width, int height, int samples);

  /// Antialiases the part of `shaded` inside `area`, in place. Expects the geometry buffer bound to unit 4 and the
  /// frame block. `far` is the distance at which the geometry buffer has the backdrop [m].
  void draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const Texture& shaded,
            const PixelArea& area, double far);

 private:
  const Gl* gl_;
  int width_, height_;
  Program surface_, rest_;
  Texture color_, depth_;
  Framebuffer target_, resolved_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
