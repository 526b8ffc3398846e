#include "film/render/shading.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "film/image/color.hpp"

namespace weft::render {
namespace {

std::vector<std::string> shading_defines(const LightSet& lights, const std::vector<const char*>& more = {}) {
  std::vector<std::string> defines{"LIGHTS " + std::to_string(lights.count)};
  if (lights.spots) defines.push_back("SPOTS");
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

// Cloth thicker than kTopstitchedThickness [m] has topstitching on both sides of a seam, at kTopstitchDistance [m].
constexpr double kTopstitchedThickness = 0.7e-3, kTopstitchDistance = 4e-3;

// Gloss of cotton. Up to this Finish::gloss, highlights of threads are below half a level of 255; shaders skip them.
constexpr double kMaxMatteGloss = 0.1;

Texture make_heat_colors(const Gl& gl) {
  std::vector<float> texels;
  for (const Vec3& color : image::heat_table()) {
    for (const double channel : color) texels.push_back(static_cast<float>(channel));
  }
  Texture texture = make_texture(gl, GL_RGB32F, image::kHeatColors, 1, GL_LINEAR);
  gl.TextureSubImage2D(texture.name(), 0, 0, 0, image::kHeatColors, 1, GL_RGB, GL_FLOAT, texels.data());
  return texture;
}

Eigen::Vector4f texel(const Vec3& color, double fourth) {
  Eigen::Vector4f result;
  result << image::linear_from_srgb(color).cast<float>(), static_cast<float>(fourth);
  return result;
}

float clip_of(int pixel, int size) {
  return 2 * static_cast<float>(pixel) / static_cast<float>(size) - 1;
}

/// The grid on which slowly varying colours are interpolated: cells of two triangles each. It is too coarse for the
/// floor if fades_steeply() is true.
struct Grid {
  std::vector<Eigen::Vector2f> corners;
  std::vector<GLuint> triangles;

  Grid(int width, int height) {
    constexpr int kCell = Shading::kGridCell;
    const int columns = (width + kCell - 1) / kCell, rows = (height + kCell - 1) / kCell;
    for (int row = 0; row <= rows; ++row) {
      for (int column = 0; column <= columns; ++column) {
        corners.emplace_back(clip_of(kCell * column, width), clip_of(kCell * row, height));
      }
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const auto a = static_cast<GLuint>(row * (columns + 1) + column), c = a + static_cast<GLuint>(columns) + 1;
        triangles.insert(triangles.end(), {a, a + 1, c + 1, a, c + 1, c});
      }
    }
  }
};

}  // namespace

frame::Appearance clay(const frame::Appearance& look) {
  frame::Appearance plain = look;
  plain.color = Vec3(0.74, 0.72, 0.69);
  plain.back_color = Vec3(0.60, 0.58, 0.56);
  plain.paint = {};  // reflected light has no pictures either
  plain.roughness = 0.7;
  plain.thread_spacing = 0;
  plain.finish = {0, 0.5, 0.2, 0};
  plain.metal = plain.coat = 0;
  plain.hem = 0;
  return plain;
}

double opacity_of(const frame::Surface& surface) {
  constexpr double kFirst = 0.5, kSlope = 1.25;  // chiffon, whose `sheer` is 0.9, stops half of the light
  if (surface.kind != frame::ObjectKind::cloth) return 1;
  return 1 - kSlope * std::clamp(surface.appearance.finish.sheer - kFirst, 0.0, 0.5);
}

bool is_skin(const frame::Surface& surface) {
  return surface.kind == frame::ObjectKind::character && !surface.parts.empty() &&
         surface.parts.front().appearance.paint.alpha == frame::Paint::Alpha::over_color;
}

Shading::Material material_of(const frame::Surface& surface, bool plain) {
  const bool cloth = surface.kind == frame::ObjectKind::cloth;
  return {plain ? clay(surface.appearance) : surface.appearance, cloth, opacity_of(surface), !plain && is_skin(surface),
          cloth || surface.kind == frame::ObjectKind::rope};
}

Shading::Shading(const Gl& gl, const QualitySettings& quality, int width, int height, const GeometryBuffer& geometry)
    : gl_(&gl),
      width_(width),
      height_(height),
      quality_(quality),
      backdrop_(gl, "backdrop.vert", "grid.frag", shading_defines({})),
      areas_(gl, "areas.vert", ""),
      picture_(make_texture(gl, GL_RGBA16, width, height, GL_NEAREST)),
      heat_colors_(make_heat_colors(gl)),
      target_(gl),
      no_vertices_(gl),
      area_array_(gl),
      grid_array_(gl),
      area_vertices_(gl),
      grid_vertices_(gl),
      grid_triangles_(gl) {
  add_attribute(gl, area_array_, 0, area_vertices_, 2);  // two coordinates in clip space
  add_attribute(gl, grid_array_, 0, grid_vertices_, 2);
  const Grid grid(width, height);
  upload<Eigen::Vector2f>(gl, grid_vertices_, grid.corners);
  upload<GLuint>(gl, grid_triangles_, grid.triangles);
  gl.VertexArrayElementBuffer(grid_array_.name(), grid_triangles_.name());
  grid_indices_ = static_cast<GLsizei>(grid.triangles.size());
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_STENCIL_ATTACHMENT, geometry.depth_stencil().name(), 0);
  check_framebuffer(gl, target_, "picture");
}

// The light of a sun on open floor, and the fading of the floor into the backdrop, vary so slowly over the picture that
// they can be interpolated on a grid. Checkers, pictures, reflections and steep fading vary too fast. The light of
// spots is interpolated only in qualities with spots_on_grid, because the edges of the cones become inaccurate.
Shading::Programs::Programs(const Gl& gl, const QualitySettings& quality, const Features& features)
    : floor_on_grid((quality.spots_on_grid || !features.lights.spots) && !features.checker && !features.tiled &&
                    !features.reflecting && !features.steep) {
  const LightSet& lights = features.lights;
  std::vector<const char*> of_solid(features.painted ? 1 : 0, "PAINTED");
  if (features.heat) of_solid.push_back("HEAT");
  std::vector<const char*> of_cloth = of_solid;
  if (features.glossy) of_cloth.push_back("GLOSSY");
  of_cloth.push_back("CLOTH");
  if (features.trimmed) of_cloth.push_back("TRIMMED");
  if (features.sheer) of_cloth.push_back("SHEER");
  cloth = Program(gl, "fullscreen.vert", "surface.frag", shading_defines(lights, of_cloth));
  if (features.sheer) return;
  if (features.metal) of_solid.push_back("METAL");
  if (features.skin && features.painted) of_solid.push_back("SKIN");
  solid = Program(gl, "fullscreen.vert", "surface.frag", shading_defines(lights, of_solid));
  std::vector<const char*> floor{features.checker ? "CHECKER" : "PLAIN"};
  const std::vector<const char*> shiny(features.shiny ? 1 : 0, "SHINY");
  floor.insert(floor.end(), shiny.begin(), shiny.end());
  if (features.reflecting) floor.push_back("REFLECTING");
  if (features.tiled) floor.push_back("TILED");
  shaded_floor = Program(gl, "fullscreen.vert", "floor.frag", shading_defines(lights, floor));
  floor.push_back("OPEN");
  open_floor = floor_on_grid ? Program(gl, "open_floor.vert", "grid.frag", shading_defines(lights, shiny))
                             : Program(gl, "fullscreen.vert", "floor.frag", shading_defines(lights, floor));
}

const Shading::Programs& Shading::programs(Features features) {
  features.glossy = glossy_;
  features.metal = metal_;
  features.skin = skin_;
  features.heat = heat_;
  const auto known = programs_.find(features);
  if (known != programs_.end()) return known->second;
  return programs_.emplace(features, Programs(*gl_, quality_, features)).first->second;
}

void Shading::upload_materials(std::span<const Material> materials, double heat_scale) {
  constexpr int kColumns = 5;  // as in surface.frag
  std::vector<Eigen::Vector4f> texels;
  heat_ = heat_scale > 0;
  glossy_ = std::ranges::any_of(materials, [](const Material& material) {
    return material.cloth && material.appearance.finish.gloss > kMaxMatteGloss;
  });
  metal_ = std::ranges::any_of(materials, [](const Material& material) {
    return !material.cloth && (material.appearance.metal > 0 || material.appearance.coat > 0);
  });
  skin_ = std::ranges::any_of(materials, &Material::skin);
  for (const auto& [look, cloth, opacity, skin, has_heat] : materials) {
    texels.push_back(texel(look.color, std::clamp(look.roughness, 0.0, 1.0)));
    texels.push_back(texel(look.back_color, look.thread_spacing));
    texels.push_back(Eigen::Vector4d(has_heat ? heat_scale : 0, look.hem, look.thickness,
                                     look.thickness > kTopstitchedThickness ? kTopstitchDistance : 0)
                         .cast<float>());
    const frame::Finish& finish = look.finish;
    texels.push_back(Eigen::Vector4d(cloth ? finish.gloss : look.coat, cloth ? finish.warp_fraction : look.metal,
                                     finish.fuzz, finish.sheer)
                         .cast<float>());
    texels.emplace_back(static_cast<float>(opacity), static_cast<float>(finish.threads), skin ? 1.0f : 0.0f, 0.0f);
  }
  const int rows = static_cast<int>(materials.size());
  if (rows > material_rows_) {
    materials_ = make_texture(*gl_, GL_RGBA32F, kColumns, rows, GL_NEAREST);
    material_rows_ = rows;
  }
  if (rows > 0) gl_->TextureSubImage2D(materials_.name(), 0, 0, 0, kColumns, rows, GL_RGBA, GL_FLOAT, texels.data());
}

void Shading::set_floor(const Floor& floor, double tint) {
  if (!floor.look.paint.texture) return;
  if (!floor_pictures_) floor_pictures_.emplace(*gl_);
  floor_picture_ = floor_pictures_->of(floor.look.paint).texture.name();
  floor_tint_ = static_cast<float>(tint);
  floor_picture_from_world_ = floor.picture_from_world.cast<float>();
}

/// Runs a program for all pixels that pass the stencil test. `on_grid`: it computes colours only at the corners of the
/// grid.
void Shading::run(const Program& program, const Features& features, bool on_grid) const {
  program.use();
  if (features.tiled) {
    constexpr GLuint kUnit = 16;  // as in floor.frag
    gl_->BindTextureUnit(kUnit, floor_picture_);
    const Eigen::Vector4f across = floor_picture_from_world_.row(0), up = floor_picture_from_world_.row(1);
    gl_->Uniform4f(program.uniform("picture_across"), across.x(), across.y(), across.z(), across.w());
    gl_->Uniform1f(program.uniform("tint"), floor_tint_);
    gl_->Uniform4f(program.uniform("picture_up"), up.x(), up.y(), up.z(), up.w());
  }
  gl_->BindVertexArray((on_grid ? grid_array_ : no_vertices_).name());
  if (on_grid) {
    gl_->DrawElements(GL_TRIANGLES, grid_indices_, GL_UNSIGNED_INT, nullptr);
  } else {
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
}

void Shading::mark_shaded_floor(std::span<const PixelArea> areas) {
  if (areas.empty()) return;
  std::vector<Eigen::Vector2f> corners;
  for (const PixelArea& area : areas) {
    const float x0 = clip_of(area.x, width_), x1 = clip_of(area.x + area.width, width_);
    const float y0 = clip_of(area.y, height_), y1 = clip_of(area.y + area.height, height_);
    corners.insert(corners.end(), {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y0}, {x1, y1}, {x0, y1}});
  }
  upload<Eigen::Vector2f>(*gl_, area_vertices_, corners);
  // Marks only pixels of the floor, because no other class has both lower bits set.
  gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(PixelClass::shaded_floor), static_cast<GLuint>(PixelClass::floor));
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  gl_->BindVertexArray(area_array_.name());
  areas_.use();
  gl_->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl_->DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Shading::bind() {
  gl_->BindTextureUnit(6, heat_colors_.name());
  gl_->BindTextureUnit(7, materials_.name());
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Enable(GL_STENCIL_TEST);
}

void Shading::draw_layer(Features features, const PixelArea& subjects) {
  features.sheer = true;
  const Programs& chosen = programs(features);
  bind();
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(PixelClass::cloth), 0xFF);
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(subjects.x, subjects.y, subjects.width, subjects.height);
  run(chosen.cloth, features, false);
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_STENCIL_TEST);
}

void Shading::draw_open_floor(const Features& features) {
  const Programs& chosen = programs(features);
  bind();
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  // Selects both classes of floor, which have the same lower bits.
  gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(PixelClass::floor), static_cast<GLuint>(PixelClass::floor));
  run(chosen.open_floor, features, chosen.floor_on_grid);
  gl_->Disable(GL_STENCIL_TEST);
}

void Shading::draw(std::span<const Material> materials, double heat_scale, const Features& features,
                   const PixelArea& subjects, std::span<const PixelArea> shaded_floor) {
  upload_materials(materials, heat_scale);
  const Programs& chosen = programs(features);
  bind();
  mark_shaded_floor(shaded_floor);
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  // With the stencil test, the rasteriser skips blocks without pixels of the class.
  const auto shade = [&](PixelClass pixel_class, const Program& program, bool on_grid = false) {
    gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(pixel_class), 0xFF);
    run(program, features, on_grid);
  };
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(subjects.x, subjects.y, subjects.width, subjects.height);
  shade(PixelClass::cloth, chosen.cloth);
  shade(PixelClass::solid, chosen.solid);
  gl_->Disable(GL_SCISSOR_TEST);
  if (!shaded_floor.empty()) shade(PixelClass::shaded_floor, chosen.shaded_floor);
  shade(PixelClass::floor, chosen.open_floor, chosen.floor_on_grid);
  shade(PixelClass::backdrop, backdrop_, true);
  gl_->Disable(GL_STENCIL_TEST);
}

void Shading::read(std::vector<std::uint64_t>& rgba) const {
  rgba.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_->GetTextureImage(picture_.name(), 0, GL_RGBA, GL_UNSIGNED_SHORT, static_cast<GLsizei>(8 * rgba.size()),
                       rgba.data());
}

frame::Stage::Heat heat_shown(const frame::FrameSnapshot& snapshot, const frame::Stage& stage) {
  using Look = frame::Stage::Look;
  if (stage.look == Look::clay || stage.look == Look::wire) return frame::Stage::Heat::none;
  if (stage.look != Look::strain) return stage.heat;
  const auto has_heat = [](const frame::SurfaceState& state) { return !state.heat.empty(); };
  if (stage.heat != frame::Stage::Heat::strain || std::ranges::none_of(snapshot.states, has_heat)) {
    throw Error(
        ExitCode::usage,
        "frame {}: the look strain needs what only a simulation finds; expected frames that were simulated with "
        "render.look=strain or render.heat=strain",
        snapshot.frame);
  }
  return stage.heat;
}

double heat_scale(const frame::FrameSnapshot& snapshot, const frame::Stage& stage) {
  if (stage.heat == frame::Stage::Heat::none) return 0;
  double hottest = stage.heat_max;
  if (hottest <= 0) {
    for (const frame::SurfaceState& state : snapshot.states) {
      for (const float heat : state.heat) hottest = std::max(hottest, static_cast<double>(heat));
    }
  }
  // If the largest value is 0, all cloth has the coldest colour; the scale then has no effect.
  return hottest > 0 ? 1 / hottest : 1;
}

}  // namespace weft::render
