// What each pixel shows before shading: normal, heat, rest coordinates, distance and surface.
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

/// Stencil values that select the shading pass. A floor pixel becomes shaded floor if Shading finds that soft light
/// changes it; the lower two bits keep the class.
enum class PixelClass : int { backdrop = 0, cloth = 1, solid = 2, floor = 3, shaded_floor = 7 };

class GeometryBuffer {
 public:
  GeometryBuffer(const Gl& gl, int width, int height);

  /// Draws all surfaces except those flagged in `left_out` (empty: none) and, if not null, the floor, as seen from
  /// `eye`. `far`: distance stored where nothing is visible [m]. Binds the results to units 4, 5 and 8; colours to unit
  /// 10 if something is painted; trims to unit 11 if cloth has hems.
  void draw(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, const FloorBuffers* floor,
            const Vec3& eye, double far);
  /// Draws over the result of draw() the nearest layer of the surfaces flagged in `left_out`, with class cloth, and
  /// replaces an earlier layer. `deeper`: the nearest layer behind the one of the previous call.
  void draw_layer(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, bool deeper);

  /// Whether the last picture contains painted pictures, or parts of different colours.
  bool painted() const { return painted_; }
  /// Whether some cloth has visible hems or seams.
  bool trimmed() const { return trimmed_; }
  /// Opacity of each painted range of a surface, in the form that Holes expects.
  std::vector<const Opacity*> opacity_of(const PaintedMesh& mesh);

  /// Reads back what each pixel shows, lowest row first.
  void read_seen(std::vector<Seen>& seen) const;
  /// World normal of each pixel that shows a surface, times 1 + `rise` (geometry.frag); w: heat.
  void read_normals(std::vector<Eigen::Vector4f>& normals) const;

  /// Distance and surface of each pixel, as Seen.
  const Texture& seen() const { return seen_; }
  /// Depth and stencil, for the passes that shade by class.
  const Texture& depth_stencil() const { return depth_stencil_; }

 private:
  /// Shader variant. All surfaces of a painted or trimmed picture also write whether they have paint or trims.
  struct Variant {
    bool painted = false, pictured = false, holes = false, trimmed = false, peeled = false;
    auto operator<=>(const Variant&) const = default;
  };
  struct GeometryProgram {
    Program program;
    GLint surface, nearer, picture_u, picture_v, laid, color, back_color;
    GeometryProgram(const Gl& gl, const Variant& variant);
  };
  const GeometryProgram& use(const Variant& variant);
  void set_class(PixelClass pixel_class) const;
  void attach(bool painted, bool trimmed);
  void begin(std::span<const SurfaceBuffers> surfaces);
  void end();
  void draw(const SurfaceBuffers& surface, float number, bool peeled);
  void copy(const Texture& from, const Texture& to) const;

  /// Resources created on first use: for painted surfaces, and for cloth that is seen through.
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
  std::map<Variant, GeometryProgram> programs_;
  Texture normal_heat_, uv_, seen_, depth_stencil_, trims_;
  Framebuffer target_;
  std::optional<Painting> painting_;
  std::optional<Layers> layers_;
  bool painted_ = false, trimmed_ = false;
};

}  // namespace weft::render
