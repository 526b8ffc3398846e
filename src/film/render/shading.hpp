// Light and colour of every pixel of the geometry buffer.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <span>

#include "film/render/geometry_buffer.hpp"
#include "film/render/gl/program.hpp"
#include "film/render/lighting.hpp"
#include "film/render/paints.hpp"
#include "film/render/quality.hpp"
#include "film/render/view.hpp"

namespace weft::render {

class Shading {
 public:
  /// Side of the cells of the grid on which the colours of open floor and backdrop are interpolated [pixels].
  static constexpr int kGridCell = 16;

  Shading(const Gl& gl, const QualitySettings& quality, int width, int height, const GeometryBuffer& geometry);

  /// Optical properties of one surface.
  struct Material {
    frame::Appearance appearance;
    bool cloth = false;
    double opacity = 1;     ///< at normal incidence
    bool skin = false;      ///< shaded as skin where no picture covers its colour
    bool has_heat = false;  ///< shows the colours of heat, as cloth and ropes do
  };
  /// Features that select shader variants.
  struct Features {
    LightSet lights;
    bool checker = false;     ///< checkered floor
    bool tiled = false;       ///< the floor shows the picture of set_floor()
    bool painted = false;     ///< the geometry buffer has colours
    bool trimmed = false;     ///< the geometry buffer has hems and seams
    bool shiny = false;       ///< the floor has highlights of lamps
    bool reflecting = false;  ///< the floor reflects the picture of a Mirror
    bool steep = false;       ///< the floor fades too steeply for the grid: fades_steeply() over kGridCell
    bool sheer = false;       ///< cloth writes its opacity
    bool glossy = false;      ///< some cloth has shiny threads; set by draw(), as are the next three
    bool metal = false;       ///< some surface other than cloth is metal or has a clear coat
    bool skin = false;        ///< some surface has skin
    bool heat = false;        ///< the colour scale of heat replaces the colours of cloth and ropes
    auto operator<=>(const Features&) const = default;
  };
  /// Sets the floor whose picture is drawn, and `tint`, a factor on the colour of that picture.
  /// Does nothing if the floor has no picture. Call before draw().
  void set_floor(const Floor& floor, double tint);
  /// Computes the colours of the picture. `materials`: in the order of the surfaces. `heat_scale`: result of
  /// heat_scale(). `subjects`: area that contains all surfaces. Outside `shaded_floor`, the floor is drawn without
  /// shadow, occlusion and reflected light. The frame and light blocks, the textures of TracedLight and those of the
  /// geometry buffer must be bound.
  void draw(std::span<const Material> materials, double heat_scale, const Features& features, const PixelArea& subjects,
            std::span<const PixelArea> shaded_floor);
  /// Draws the whole floor again, without shadow, occlusion and light from other surfaces. Call
  /// after draw() of the same picture.
  void draw_open_floor(const Features& features);
  /// Draws cloth only and writes its opacity to alpha. Call after draw() of the same picture.
  void draw_layer(Features features, const PixelArea& subjects);

  const Texture& picture() const { return picture_; }
  /// Reads the picture: RGBA of 16 bits each in sRGB, lowest row first.
  void read(std::vector<std::uint64_t>& rgba) const;

 private:
  void upload_materials(std::span<const Material> materials, double heat_scale);
  void run(const Program& program, const Features& features, bool on_grid) const;
  void mark_shaded_floor(std::span<const PixelArea> areas);

  struct Programs {
    Program cloth, solid, open_floor, shaded_floor;
    bool floor_on_grid;  // the program `open_floor` computes light only at the corners of the grid
    Programs(const Gl& gl, const QualitySettings& quality, const Features& features);
  };
  const Programs& programs(Features features);
  void bind();

  const Gl* gl_;
  int width_, height_;
  QualitySettings quality_;
  std::map<Features, Programs> programs_;  // made on first use
  Program backdrop_, areas_;
  Texture picture_, heat_colors_, materials_;
  Framebuffer target_;
  VertexArray no_vertices_, area_array_, grid_array_;
  Buffer area_vertices_, grid_vertices_, grid_triangles_;
  GLsizei grid_indices_ = 0;
  int material_rows_ = 0;
  bool glossy_ = false, metal_ = false, skin_ = false, heat_ = false;  // present among the materials
  std::optional<Paints> floor_pictures_;                               // made once a floor has a picture
  GLuint floor_picture_ = 0;
  float floor_tint_ = 1;
  Eigen::Matrix<float, 2, 4> floor_picture_from_world_ = Eigen::Matrix<float, 2, 4>::Zero();
};

/// Fraction of the light that a surface stops at normal incidence. It is below 1 only for cloth
/// whose Finish::sheer exceeds 0.5. Denser weaves scatter light to the other side, but nothing is
/// visible through them.
double opacity_of(const frame::Surface& surface);

/// Whether a body shows skin where no picture covers its colour. True for characters whose first part has
/// Alpha::over_color, such as the mannequin.
bool is_skin(const frame::Surface& surface);

/// Replaces colours, roughness and finish of an appearance with those of clay, without picture,
/// threads, hem, metal and coat.
frame::Appearance clay(const frame::Appearance& look);

/// The material of a surface. `plain`: clay in place of its own colours.
Shading::Material material_of(const frame::Surface& surface, bool plain);

/// The heat to show in a frame: none for the looks `clay` and `wire`, strain for the look `strain`, else Stage::heat.
/// Throws Error(usage) if the look is `strain` and the frame has no strain.
frame::Stage::Heat heat_shown(const frame::FrameSnapshot& snapshot, const frame::Stage& stage);

/// 1 / the value of heat that has the hottest colour; 0 if no heat is drawn.
double heat_scale(const frame::FrameSnapshot& snapshot, const frame::Stage& stage);

}  // namespace weft::render
