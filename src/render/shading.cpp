#include "render/shading.hpp"

#include <algorithm>

#include "image/color.hpp"
#include "render/soft_light.hpp"

namespace weft::render {
namespace {

std::vector<std::string> shading_defines(const QualitySettings& quality, std::size_t light_count, bool full_shadows,
                                         const char* more = nullptr) {
  std::vector<std::string> defines = ShadowMaps::defines(quality, light_count);
  if (full_shadows) defines.push_back("FULL_SHADOWS");
  if (more) defines.push_back(more);
  return defines;
}

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

}  // namespace

Shading::Shading(const Gl& gl, const QualitySettings& quality, int width, int height, const GeometryBuffer& geometry)
    : gl_(&gl),
      width_(width),
      height_(height),
      quality_(quality),
      backdrop_(gl, "fullscreen.vert", "backdrop.frag", shading_defines(quality, 1, false)),
      areas_(gl, "areas.vert", ""),
      picture_(make_texture(gl, GL_RGBA8, width, height, GL_NEAREST)),
      heat_colors_(make_heat_colors(gl)),
      target_(gl),
      no_vertices_(gl),
      area_array_(gl),
      area_vertices_(gl) {
  gl.VertexArrayVertexBuffer(area_array_.name(), 0, area_vertices_.name(), 0, sizeof(Eigen::Vector2f));
  gl.EnableVertexArrayAttrib(area_array_.name(), 0);
  gl.VertexArrayAttribFormat(area_array_.name(), 0, 2, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(area_array_.name(), 0, 0);
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_STENCIL_ATTACHMENT, geometry.depth_stencil().name(), 0);
  check_framebuffer(gl, target_, "picture");
}

// The first lights' shadows on the floor are as soft as the small picture has them.
Shading::Programs::Programs(const Gl& gl, const QualitySettings& quality, std::size_t light_count)
    : cloth(gl, "fullscreen.vert", "surface.frag",
            shading_defines(quality, light_count, quality.crisp_shadows || light_count > kSoftLights, "CLOTH")),
      solid(gl, "fullscreen.vert", "surface.frag",
            shading_defines(quality, light_count, quality.crisp_shadows || light_count > kSoftLights)),
      open_floor(gl, "fullscreen.vert", "floor.frag", shading_defines(quality, light_count, false, "OPEN")),
      shaded_floor(gl, "fullscreen.vert", "floor.frag",
                   shading_defines(quality, light_count, light_count > kSoftLights)) {}

void Shading::upload_materials(std::span<const Material> materials, double heat_scale) {
  constexpr int kColumns = 3;  // of shading.glsl
  std::vector<Eigen::Vector4f> texels;
  for (const auto& [look, cloth] : materials) {
    texels.push_back(texel(look.color, std::clamp(look.roughness, 0.0, 1.0)));
    texels.push_back(texel(look.back_color, look.thread_spacing));
    texels.emplace_back(cloth ? static_cast<float>(heat_scale) : 0.0f, 0.0f, 0.0f, 0.0f);
  }
  const int rows = static_cast<int>(materials.size());
  if (rows > material_rows_) {
    materials_ = make_texture(*gl_, GL_RGBA32F, kColumns, rows, GL_NEAREST);
    material_rows_ = rows;
  }
  if (rows > 0) gl_->TextureSubImage2D(materials_.name(), 0, 0, 0, kColumns, rows, GL_RGBA, GL_FLOAT, texels.data());
}

void Shading::mark_shaded_floor(std::span<const PixelArea> areas) {
  if (areas.empty()) return;
  std::vector<Eigen::Vector2f> corners;
  const auto clip = [](int pixel, int size) { return 2 * static_cast<float>(pixel) / static_cast<float>(size) - 1; };
  for (const PixelArea& area : areas) {
    const float x0 = clip(area.x, width_), x1 = clip(area.x + area.width, width_);
    const float y0 = clip(area.y, height_), y1 = clip(area.y + area.height, height_);
    corners.insert(corners.end(), {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y0}, {x1, y1}, {x0, y1}});
  }
  upload<Eigen::Vector2f>(*gl_, area_vertices_, corners);
  // Only floor has both of the lower bits.
  gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(PixelClass::shaded_floor), static_cast<GLuint>(PixelClass::floor));
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  gl_->BindVertexArray(area_array_.name());
  areas_.use();
  gl_->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl_->DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_->BindVertexArray(no_vertices_.name());
}

void Shading::draw(std::span<const Material> materials, double heat_scale, std::size_t light_count,
                   const PixelArea& subjects, std::span<const PixelArea> shaded_floor) {
  std::optional<Programs>& programs = programs_[light_count - 1];
  if (!programs) programs.emplace(*gl_, quality_, light_count);
  upload_materials(materials, heat_scale);
  gl_->BindTextureUnit(6, heat_colors_.name());
  gl_->BindTextureUnit(7, materials_.name());
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Enable(GL_STENCIL_TEST);
  mark_shaded_floor(shaded_floor);
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  gl_->BindVertexArray(no_vertices_.name());
  // Blocks without a pixel of the class are left after the stencil test.
  const auto shade = [&](PixelClass pixel_class, const Program& program) {
    gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(pixel_class), 0xFF);
    program.use();
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  };
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(subjects.x, subjects.y, subjects.width, subjects.height);
  shade(PixelClass::cloth, programs->cloth);
  shade(PixelClass::solid, programs->solid);
  gl_->Disable(GL_SCISSOR_TEST);
  if (!shaded_floor.empty()) shade(PixelClass::shaded_floor, programs->shaded_floor);
  shade(PixelClass::floor, programs->open_floor);
  shade(PixelClass::backdrop, backdrop_);
  gl_->Disable(GL_STENCIL_TEST);
}

void Shading::read(std::vector<std::uint32_t>& rgba) const {
  rgba.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_->GetTextureImage(picture_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(4 * rgba.size()),
                       rgba.data());
}

}  // namespace weft::render
