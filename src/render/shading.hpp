// Light and colour of every pixel of the geometry buffer.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <span>

#include "render/geometry_buffer.hpp"
#include "render/gl/program.hpp"
#include "render/paints.hpp"
#include "render/quality.hpp"
#include "render/shadow_maps.hpp"
#include "render/view.hpp"

namespace weft::render {

class Shading {
 public:
  Shading(const Gl& gl, const QualitySettings& quality, int width, int height, const GeometryBuffer& geometry);

  struct Material {
    frame::Appearance appearance;
    bool cloth = false;
    double opacity = 1;  ///< seen head-on
    bool skin = false;   ///< where no picture lies over its colour
  };
  /// What shaders are compiled for.
  struct Features {
    LightSet lights;
    bool checker = false;     ///< on the floor
    bool tiled = false;       ///< the floor shows the picture of set_floor()
    bool level = false;       ///< the floor, so that one axis is its normal
    bool painted = false;     ///< the geometry buffer has colours of its own
    bool trimmed = false;     ///< and hems
    bool shiny = false;       ///< the floor mirrors lamps
    bool reflecting = false;  ///< the floor shows what a Mirror has drawn, everywhere
    bool sheer = false;       ///< cloth says how opaque it is
    bool glossy = false;      ///< threads of some cloth shine; draw() sees to that, and to the next three
    bool metal = false;       ///< something that is no cloth is of metal or has a coat; likewise
    bool skin = false;        ///< something is skin; likewise
    bool heat = false;        ///< in place of colours of cloth
    auto operator<=>(const Features&) const = default;
  };
  /// The floor whose picture is drawn, and a factor on its light; before draw().
  void set_floor(const std::optional<Floor>& floor, double tint);
  /// Looks of the surfaces in the order of their materials. `heat_scale`: 1 / hottest value, 0 for the surfaces' own
  /// colours; only cloth shows heat. `subjects` holds all of them; floor is lit and open outside `shaded_floor`.
  /// Expects the frame and light blocks, shadow maps, soft light and geometry bound.
  void draw(std::span<const Material> materials, double heat_scale, const Features& features, const PixelArea& subjects,
            std::span<const PixelArea> shaded_floor);
  /// All floor as if nothing shaded it, after draw() of the same picture.
  void draw_open_floor(const Features& features);
  /// Only cloth, after draw() of the same picture; its opacity goes into alpha.
  void draw_layer(Features features, const PixelArea& subjects);

  const Texture& picture() const { return picture_; }
  /// Reads the picture: RGBA of 16 bits each in sRGB, lowest row first.
  void read(std::vector<std::uint64_t>& rgba) const;

 private:
  void upload_materials(std::span<const Material> materials, double heat_scale);
  void use_floor(const Program& program, const Features& features) const;
  void mark_shaded_floor(std::span<const PixelArea> areas);

  struct Programs {
    Program cloth, solid, open_floor, shaded_floor;
    bool floor_on_grid;  // open_floor is lit at the corners of the grid
    Programs(const Gl& gl, const QualitySettings& quality, const Features& features);
  };
  const Programs& programs(Features features);
  void bind();

  const Gl* gl_;
  int width_, height_;
  QualitySettings quality_;
  std::map<Features, Programs> programs_;  // made when first needed
  Program backdrop_, areas_;
  Texture picture_, heat_colors_, materials_;
  Framebuffer target_;
  VertexArray no_vertices_, area_array_, grid_array_;
  Buffer area_vertices_, grid_vertices_, grid_triangles_;
  GLsizei grid_indices_ = 0;
  int material_rows_ = 0;
  bool glossy_ = false, metal_ = false, skin_ = false, heat_ = false;  // of the materials
  std::optional<Paints> floor_pictures_;                               // once a floor has one
  GLuint floor_picture_ = 0;
  float floor_tint_ = 1;
  Eigen::Matrix<float, 2, 4> floor_picture_from_world_ = Eigen::Matrix<float, 2, 4>::Zero();
};

/// Share of the light that cloth stops, head-on. Dense weaves let light through, but nothing is seen behind them.
double opacity_of(const frame::Surface& surface);

/// Whether a body is bare where no picture lies over its colour, as the mannequin is.
bool is_skin(const frame::Surface& surface);

/// `plain`: of clay.
Shading::Material material_of(const frame::Surface& surface, bool plain);

/// What heat a stage shows of a frame: clay has none, and the look of strain has to have it.
frame::Stage::Heat heat_shown(const frame::FrameSnapshot& snapshot, const frame::Stage& stage);

/// 1 / value at the hot end of the scale, 0 where no heat is to be drawn.
double heat_scale(const frame::FrameSnapshot& snapshot, const frame::Stage& stage);

}  // namespace weft::render
