// The geometry buffer for deferred shading: normal, heat, rest coordinates, distance and surface of each pixel.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "film/render/gl/program.hpp"
#include "film/render/paints.hpp"
#include "film/render/seen.hpp"
#include "film/render/surface_buffers.hpp"

namespace weft::render {

/// Class of a pixel: a stencil value, by which a shading pass selects its pixels. Shading changes `floor` to
/// `shaded_floor` in areas with shadow, occlusion or reflected light; the lower two bits of both values are equal.
enum class PixelClass : int { backdrop = 0, cloth = 1, solid = 2, floor = 3, shaded_floor = 7 };

class GeometryBuffer {
 public:
  /// `clips`: for reflections in the floor of the frame block; leaves out surfaces below it while GL_CLIP_DISTANCE0 is
  /// enabled. llvmpipe clips also if this is disabled, so other pictures have no clip distances: their floor would lose
  /// parts by rounding, and surfaces below it would be invisible from below.
  GeometryBuffer(const Gl& gl, int width, int height, bool clips = false);

  /// Draws the floor (if not null) and all surfaces except those flagged in `left_out` (empty: no
  /// exceptions), in the view of the bound frame block. `eye`: position of the eye of this view
  /// [m]. `far`: distance stored where nothing is visible [m]. Binds the results to texture units:
  /// normal and heat to 4, rest coordinates to 5, seen() to 8; if painted(), colours to 10; if
  /// trimmed(), trims to 11.
  void draw(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, const FloorBuffers* floor,
            const Vec3& eye, double far);
  /// Depth peeling, for translucent cloth: draws the nearest layer of the surfaces flagged in
  /// `left_out` over the result of draw(). The pixels of the layer get PixelClass::cloth, all
  /// others PixelClass::backdrop. The new layer replaces that of the previous call. If `deeper` is
  /// true, draws the nearest layer behind that of the previous call.
  void draw_layer(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, bool deeper);

  /// Whether frame::is_painted() holds for a surface of the last picture.
  bool painted() const { return painted_; }
  /// Whether some surface of the last picture is drawn with hems and seams.
  bool trimmed() const { return trimmed_; }
  /// For each range of a painted mesh, the opacity of its picture; null if the range has no holes. Argument of Holes.
  std::vector<const Opacity*> opacity_of(const PaintedMesh& mesh);

  /// Reads distance and surface of each pixel, lowest row first.
  void read_seen(std::vector<Seen>& seen) const;
  /// Reads, for each pixel that shows a surface other than the floor, the world normal on the visible side. Its length
  /// is 1 + h, where h [m] is the height of the smooth surface above the triangle along this normal (rise() in
  /// shaders/geometry.frag). w: heat. All other pixels have arbitrary values.
  void read_normals(std::vector<Eigen::Vector4f>& normals) const;

  /// Distance and surface number of each pixel; see Seen.
  const Texture& seen() const { return seen_; }
  /// Depth and stencil, for the passes that shade by class.
  const Texture& depth_stencil() const { return depth_stencil_; }

 private:
  /// Shader variant. If any surface has paint (`painted`) or trims (`trimmed`), the shaders of all surfaces write them.
  /// pictured: the surface has a picture; holes: the picture cuts holes; peeled: for draw_layer(); clipped: for
  /// `clips`.
  struct Variant {
    bool painted = false, pictured = false, holes = false, trimmed = false, peeled = false, clipped = false;
    auto operator<=>(const Variant&) const = default;
  };
  struct GeometryProgram {
    Program program;
    GLint surface, depth_offset, picture_u, picture_v, paint_mode, color, back_color;
    GeometryProgram(const Gl& gl, const Variant& variant);
  };
  const GeometryProgram& use(const Variant& variant);
  void set_class(PixelClass pixel_class) const;
  void attach(bool painted, bool trimmed);
  void begin(std::span<const SurfaceBuffers> surfaces);
  void end();
  void draw(const SurfaceBuffers& surface, float number, bool peeled);
  void copy(const Texture& from, const Texture& to) const;

  /// Resources that are created on first use: Painting for painted surfaces, Layers for translucent cloth.
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
  bool clips_;
  std::map<Variant, GeometryProgram> programs_;
  Texture normal_heat_, uv_, seen_, depth_stencil_, trims_;
  Framebuffer target_;
  std::optional<Painting> painting_;
  std::optional<Layers> layers_;
  bool painted_ = false, trimmed_ = false;
};

}  // namespace weft::render
