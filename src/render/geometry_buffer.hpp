// What is seen at each pixel before any light: normal, distance, rest coordinates, heat and material.
#pragma once

#include <functional>
#include <span>

#include "render/gl/program.hpp"
#include "render/surface_buffers.hpp"

namespace weft::render {

/// Stencil values that tell the shading passes apart.
enum class PixelClass : int { backdrop = 0, cloth = 1, solid = 2, floor = 3 };

class GeometryBuffer {
 public:
  GeometryBuffer(const Gl& gl, int width, int height);

  /// Draws all surfaces and, where not null, the floor. Surface i gets material i, the floor the one after the last.
  /// `far` is the distance stored where nothing is [m]. Leaves the results bound to units 4 and 5, distances
  /// to unit 8.
  void draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, double far);

  /// Distances along the view axis [m], lowest row first.
  std::vector<float> read_distances() const;

  /// Depth and stencil, for the passes that shade by class.
  const Texture& depth_stencil() const { return depth_stencil_; }

 private:
  void set_class(PixelClass pixel_class) const;

  const Gl* gl_;
  int width_, height_;
  Program program_;
  GLint material_;
  Texture normal_, uv_heat_material_, distance_, depth_stencil_;
  Framebuffer target_;
};

}  // namespace weft::render
