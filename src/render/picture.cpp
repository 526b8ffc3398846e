#include "render/picture.hpp"

#include <algorithm>

#include "render/color.hpp"

namespace weft::render {
namespace {

std::vector<std::string> shading_defines(const QualitySettings& quality) {
  std::vector<std::string> defines = ShadowMaps::defines(quality);
  if (quality.occlusion_divisor > 0) defines.push_back("OCCLUSION");
  return defines;
}

std::vector<std::string> cloth_defines(const QualitySettings& quality) {
  std::vector<std::string> defines = shading_defines(quality);
  defines.push_back("CLOTH");
  return defines;
}

Texture make_heat_colors(const Gl& gl) {
  std::vector<float> texels;
  for (const Vec3& color : heat_table()) {
    for (const double channel : color) texels.push_back(static_cast<float>(channel));
  }
  Texture texture = make_texture(gl, GL_RGB32F, kHeatColors, 1, GL_LINEAR);
  gl.TextureSubImage2D(texture.name(), 0, 0, 0, kHeatColors, 1, GL_RGB, GL_FLOAT, texels.data());
  return texture;
}

void set_color(const Gl& gl, GLint place, const Vec3& srgb) {
  const Eigen::Vector3f linear = linear_from_srgb(srgb).cast<float>();
  gl.Uniform3fv(place, 1, linear.data());
}

}  // namespace

Picture::SurfaceProgram::SurfaceProgram(const Gl& gl, const char* fragment, const std::vector<std::string>& defines)
    : program(gl, "surface.vert", fragment, defines),
      front_color(program.uniform("front_color")),
      back_color(program.uniform("back_color")),
      roughness(program.uniform("roughness")),
      thread_spacing(program.uniform("thread_spacing")),
      heat_scale(program.uniform("heat_scale")),
      checker(program.uniform("checker")) {}

void Picture::SurfaceProgram::use(const Gl& gl, const frame::Appearance& appearance, double heat) const {
  program.use();
  set_color(gl, front_color, appearance.color);
  set_color(gl, back_color, appearance.back_color);
  gl.Uniform1f(roughness, static_cast<float>(std::clamp(appearance.roughness, 0.0, 1.0)));
  gl.Uniform1f(thread_spacing, static_cast<float>(appearance.thread_spacing));
  gl.Uniform1f(heat_scale, static_cast<float>(heat));
  gl.Uniform1i(checker, appearance.checker);
}

Picture::Picture(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      width_(width),
      height_(height),
      multisampled_(quality.samples > 1),
      cloth_(gl, "surface.frag", cloth_defines(quality)),
      solid_(gl, "surface.frag", shading_defines(quality)),
      floor_(gl, "floor.frag", shading_defines(quality)),
      backdrop_(gl, "fullscreen.vert", "backdrop.frag", shading_defines(quality)),
      heat_colors_(make_heat_colors(gl)),
      target_(gl),
      resolve_target_(gl),
      no_vertices_(gl) {
  resolved_ = make_texture(gl, GL_RGBA8, width, height, GL_NEAREST);
  gl.NamedFramebufferTexture(resolve_target_.name(), GL_COLOR_ATTACHMENT0, resolved_.name(), 0);
  if (multisampled_) {
    color_ = make_multisample_texture(gl, GL_RGBA8, width, height, quality.samples);
    depth_ = make_multisample_texture(gl, GL_DEPTH_COMPONENT32F, width, height, quality.samples);
  } else {
    depth_ = make_texture(gl, GL_DEPTH_COMPONENT32F, width, height, GL_NEAREST);
  }
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, (multisampled_ ? color_ : resolved_).name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  check_framebuffer(gl, target_, "picture");
  check_framebuffer(gl, resolve_target_, "picture");
}

void Picture::draw(std::span<const SurfaceBuffers* const> surfaces, const FloorBuffers* floor,
                   const frame::Appearance* floor_appearance, double heat_scale) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  const float far = 1.0f;
  gl_->ClearBufferfv(GL_DEPTH, 0, &far);
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LEQUAL);
  gl_->BindTextureUnit(4, heat_colors_.name());
  gl_->BindSampler(4, 0);
  for (const SurfaceBuffers* surface : surfaces) {
    const bool cloth = surface->surface().kind == frame::ObjectKind::cloth;
    (cloth ? cloth_ : solid_).use(*gl_, surface->surface().appearance, cloth ? heat_scale : 0.0);
    surface->draw();
  }
  // What covers most of the picture comes last, so that it is shaded only where it is seen.
  if (floor) {
    floor_.use(*gl_, *floor_appearance, 0);
    gl_->Enable(GL_CULL_FACE);
    floor->draw();
    gl_->Disable(GL_CULL_FACE);
  }
  backdrop_.use();
  gl_->BindVertexArray(no_vertices_.name());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  if (multisampled_) {
    gl_->BlitNamedFramebuffer(target_.name(), resolve_target_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                              GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

image::Image Picture::read() const {
  const std::size_t width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<std::uint8_t> rgba(width * height * 4);
  gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, resolve_target_.name());
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  image::Image image(width_, height_);
  // OpenGL's first row is the lowest.
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = rgba.data() + (height - 1 - y) * width * 4;
    std::uint8_t* to = image.rgb.data() + y * width * 3;
    for (std::size_t x = 0; x < width; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
  }
  return image;
}

}  // namespace weft::render
