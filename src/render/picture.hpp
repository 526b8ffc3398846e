// The picture itself: subjects, floor and backdrop with light and shadow, antialiased, read back into an image.
#pragma once

#include <span>

#include "image/image.hpp"
#include "render/quality.hpp"
#include "render/shadow_maps.hpp"
#include "render/surface_buffers.hpp"

namespace weft::render {

class Picture {
 public:
  Picture(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// `heat_scale`: 1 / hottest value, 0 for the surfaces' own colours. `floor` may be null. Expects the frame and light
  /// blocks, the shadow maps and the occlusion picture bound.
  void draw(std::span<const SurfaceBuffers* const> surfaces, const FloorBuffers* floor,
            const frame::Appearance* floor_appearance, double heat_scale);

  /// The finished picture, top row first.
  image::Image read() const;

 private:
  /// Places of the uniforms that differ from surface to surface; -1 where a program has none.
  struct SurfaceProgram {
    Program program;
    GLint front_color, back_color, roughness, thread_spacing, heat_scale, checker;
    SurfaceProgram(const Gl& gl, const char* fragment, const std::vector<std::string>& defines);
    void use(const Gl& gl, const frame::Appearance& appearance, double heat) const;
  };

  const Gl* gl_;
  int width_, height_;
  bool multisampled_;
  SurfaceProgram cloth_, solid_, floor_;
  Program backdrop_;
  Texture color_, depth_, resolved_, heat_colors_;
  Framebuffer target_, resolve_target_;
  VertexArray no_vertices_;
};

}  // namespace weft::render
