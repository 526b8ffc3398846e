// What is seen at each pixel before any light: normal, heat, rest coordinates, distance and surface.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/gl/program.hpp"
#include "render/paints.hpp"
#include "render/seen.hpp"
#include "render/surface_buffers.hpp"

namespace weft::render {

/// Stencil values that tell the shading passes apart. A floor pixel becomes shaded floor where Shading finds that
/// soft light changes it; the lower two bits tell the rest.
enum class PixelClass : int { backdrop = 0, cloth = 1, solid = 2, floor = 3, shaded_floor = 7 };

class GeometryBuffer {
 public:
  GeometryBuffer(const Gl& gl, int width, int height);

  /// Draws all surfaces and, where not null, the floor as seen from `eye`. `far` is the distance stored where nothing
  /// is [m]. Leaves the results bound to units 4, 5 and 8, and where something is painted its colours to unit 10.
  void draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const Vec3& eye, double far);

  /// Whether what was drawn last has pictures on it, or parts of different colours.
  bool painted() const { return painted_; }
  /// Opacity of each painted range of a surface, as Holes takes it.
  std::vector<const Opacity*> opacity_of(const PaintedMesh& mesh);

  /// Reads what each pixel shows, lowest row first.
  void read_seen(std::vector<Seen>& seen) const;

  /// Depth and stencil, for the passes that shade by class.
  const Texture& depth_stencil() const { return depth_stencil_; }

 private:
  void set_class(PixelClass pixel_class) const;
  void attach_paint(bool painted);
  void draw_painted(const SurfaceBuffers& surface, float number);

  /// What is only there once something is painted.
  struct Painting {
    struct PaintProgram {
      Program program;
      GLint surface, nearer, picture_u, picture_v, laid, color, back_color;
      PaintProgram(const Gl& gl, const std::vector<std::string>& defines);
    };
    PaintProgram whole, with_holes;
    Texture colors;
    Paints paints;
    Painting(const Gl& gl, int width, int height);
  };

  const Gl* gl_;
  int width_, height_;
  Program program_;
  GLint surface_, nearer_;
  Texture normal_heat_, uv_, seen_, depth_stencil_;
  Framebuffer target_;
  std::optional<Painting> painting_;
  bool painted_ = false;
};

}  // namespace weft::render
