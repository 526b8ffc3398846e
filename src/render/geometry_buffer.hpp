// What is seen at each pixel before any light: normal, heat, rest coordinates, distance and surface.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <tuple>
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

  /// Draws all surfaces but those of `left_out` (empty: none; else a flag for each) and, where not null, the floor as
  /// seen from `eye`. `far` is the distance stored where nothing is [m]. Leaves the results bound to units 4, 5 and 8,
  /// where something is painted its colours to unit 10, and where cloth has hems its trims to unit 11.
  void draw(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, const FloorBuffers* floor,
            const Vec3& eye, double far);
  /// Over what draw() has left, instead of what an earlier call has drawn: the nearest of what only `left_out` has, of
  /// class cloth. `deeper`: the nearest behind what that call has shown.
  void draw_layer(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, bool deeper);

  /// Whether what was drawn last has pictures on it, or parts of different colours.
  bool painted() const { return painted_; }
  /// Whether some cloth has hems or seams to show.
  bool trimmed() const { return trimmed_; }
  /// Opacity of each painted range of a surface, as Holes takes it.
  std::vector<const Opacity*> opacity_of(const PaintedMesh& mesh);

  /// Reads what each pixel shows, lowest row first.
  void read_seen(std::vector<Seen>& seen) const;

  /// Distance and surface of each pixel, as Seen.
  const Texture& seen() const { return seen_; }
  /// Depth and stencil, for the passes that shade by class.
  const Texture& depth_stencil() const { return depth_stencil_; }

 private:
  /// What is drawn how: all of a picture with paint, or hems, writes whether it has them.
  struct Way {
    bool painted = false, pictured = false, holes = false, trimmed = false, peeled = false;
    auto operator<=>(const Way&) const = default;
  };
  struct GeometryProgram {
    Program program;
    GLint surface, nearer, picture_u, picture_v, laid, color, back_color;
    GeometryProgram(const Gl& gl, const Way& way);
  };
  const GeometryProgram& use(const Way& way);
  void set_class(PixelClass pixel_class) const;
  void attach(bool painted, bool trimmed);
  void begin(std::span<const SurfaceBuffers> surfaces);
  void end();
  void draw(const SurfaceBuffers& surface, float number, bool peeled);
  void copy(const Texture& from, const Texture& to) const;

  /// What is only there once something is painted, once cloth has hems, and once some can be seen through.
  struct Painting {
    Texture colors;
    Paints paints;
    Painting(const Gl& gl, int width, int height);
  };
  struct Layers {
    Texture peeled, seen, depth_stencil;
    Layers(const Gl& gl, int width, int height);
  };

  const Gl* gl_;
  int width_, height_;
  std::map<Way, GeometryProgram> programs_;
  Texture normal_heat_, uv_, seen_, depth_stencil_, trims_;
  Framebuffer target_;
  std::optional<Painting> painting_;
  std::optional<Layers> layers_;
  bool painted_ = false, trimmed_ = false;
};

}  // namespace weft::render
