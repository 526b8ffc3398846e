#include "render/shading.hpp"

#include <algorithm>

#include "image/color.hpp"

namespace weft::render {
namespace {

std::vector<std::string> shading_defines(const QualitySettings& quality, bool full_shadows, bool cloth = false) {
  std::vector<std::string> defines = ShadowMaps::defines(quality);
  if (quality.soft_divisor > 0) defines.push_back("SOFT_LIGHT");
  if (full_shadows) defines.push_back("FULL_SHADOWS");
  if (cloth) defines.push_back("CLOTH");
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
      picture_(make_texture(gl, GL_RGBA8, width, height, GL_NEAREST)),
      heat_colors_(make_heat_colors(gl)),
      target_(gl),
      no_vertices_(gl) {
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_STENCIL_ATTACHMENT, geometry.depth_stencil().name(), 0);
  check_framebuffer(gl, target_, "picture");
}

Shading::Programs::Programs(const Gl& gl, const QualitySettings& quality, bool many_lights)
    : cloth(gl, "fullscreen.vert", "surface.frag",
            shading_defines(quality, many_lights || quality.crisp_shadows, true)),
      solid(gl, "fullscreen.vert", "surface.frag", shading_defines(quality, many_lights || quality.crisp_shadows)),
      // The floor takes the first light's shadows as soft as the small picture has them, where there is one.
      floor(gl, "fullscreen.vert", "floor.frag", shading_defines(quality, many_lights || quality.soft_divisor == 0)),
      backdrop(gl, "fullscreen.vert", "backdrop.frag", shading_defines(quality, false)) {}

void Shading::upload_materials(std::span<const Material> materials, double heat_scale) {
  constexpr int kColumns = 3;  // of shading.glsl
  std::vector<Eigen::Vector4f> texels;
  for (const auto& [look, cloth] : materials) {
    texels.push_back(texel(look.color, std::clamp(look.roughness, 0.0, 1.0)));
    texels.push_back(texel(look.back_color, look.thread_spacing));
    texels.emplace_back(cloth ? static_cast<float>(heat_scale) : 0.0f, look.checker ? 1.0f : 0.0f, 0.0f, 0.0f);
  }
  const int rows = static_cast<int>(materials.size());
  if (rows > material_rows_) {
    materials_ = make_texture(*gl_, GL_RGBA32F, kColumns, rows, GL_NEAREST);
    material_rows_ = rows;
  }
  if (rows > 0) gl_->TextureSubImage2D(materials_.name(), 0, 0, 0, kColumns, rows, GL_RGBA, GL_FLOAT, texels.data());
}

void Shading::draw(std::span<const Material> materials, double heat_scale, std::size_t light_count) {
  std::optional<Programs>& programs = light_count > 1 ? many_lights_ : one_light_;
  if (!programs) programs.emplace(*gl_, quality_, light_count > 1);
  upload_materials(materials, heat_scale);
  gl_->BindTextureUnit(6, heat_colors_.name());
  gl_->BindTextureUnit(7, materials_.name());
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->BindVertexArray(no_vertices_.name());
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Enable(GL_STENCIL_TEST);
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  // Blocks without a pixel of the class are left after the stencil test.
  const std::pair<PixelClass, const Program*> passes[] = {{PixelClass::cloth, &programs->cloth},
                                                          {PixelClass::solid, &programs->solid},
                                                          {PixelClass::floor, &programs->floor},
                                                          {PixelClass::backdrop, &programs->backdrop}};
  for (const auto& [pixel_class, program] : passes) {
    gl_->StencilFunc(GL_EQUAL, static_cast<GLint>(pixel_class), 0xFF);
    program->use();
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_->Disable(GL_STENCIL_TEST);
}

}  // namespace weft::render
