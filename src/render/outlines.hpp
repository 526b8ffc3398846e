// Antialiasing: the geometry once more with several samples a pixel, coloured from the shaded picture.
#pragma once

#include <span>

#include "render/geometry_buffer.hpp"
#include "render/gl/program.hpp"
#include "render/outline_tiles.hpp"
#include "render/view.hpp"

namespace weft::render {

class Outlines {
 public:
  Outlines(const Gl& gl, int width, int height, int samples);

  /// Antialiases the part of `shaded` inside `area`, in place. Expects the distances of the geometry buffer bound to
  /// unit 8 and the frame block.
  void draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const GeometryBuffer& geometry,
            const Texture& shaded, const View& view, const PixelArea& area);

 private:
  void draw_surface(const SurfaceBuffers& surface, const View& view, const OutlineTiles& tiles) const;

  const Gl* gl_;
  int width_, height_;
  Program inside_, surface_, rest_;
  Texture color_, depth_;
  Framebuffer target_, resolved_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
