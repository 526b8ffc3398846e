// Antialiasing: the geometry once more with several samples a pixel, coloured from the shaded picture.
#pragma once

#include <span>

#include "render/gl/program.hpp"
#include "render/surface_buffers.hpp"

namespace weft::render {

class Outlines {
 public:
  Outlines(const Gl& gl, int width, int height, int samples);

  /// Expects the geometry buffer bound to unit 4 and the frame block. Backdrop: what is at `far` metres.
  void draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const Texture& shaded, double far);

  /// The antialiased picture, lowest row first.
  const Texture& picture() const { return picture_; }

 private:
  const Gl* gl_;
  int width_, height_;
  Program surface_, rest_;
  Texture color_, depth_, picture_;
  Framebuffer target_, resolved_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
