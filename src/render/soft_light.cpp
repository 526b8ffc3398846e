#include "render/soft_light.hpp"

#include <algorithm>

namespace weft::render {
namespace {

constexpr int kSkySize = 256;  // texels: the dark under things is soft anyway

std::vector<std::string> soft_light_defines(const QualitySettings& quality) {
  std::vector<std::string> defines = ShadowMaps::defines(quality);
  defines.push_back("NEARBY_TAPS " + std::to_string(quality.nearby_taps));
  defines.push_back("SKY_TAPS " + std::to_string(quality.sky_taps));
  defines.push_back("REDUCTION " + std::to_string(quality.soft_divisor));
  return defines;
}

}  // namespace

SoftLight::SoftLight(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      width_(std::max(1, width / quality.soft_divisor)),
      height_(std::max(1, height / quality.soft_divisor)),
      soft_light_(gl, "fullscreen.vert", "soft_light.frag", soft_light_defines(quality)),
      blur_(gl, "fullscreen.vert", "soft_light_blur.frag", {"RADIUS 2"}),
      sky_(make_texture_array(gl, GL_DEPTH_COMPONENT32F, kSkySize, kSkySize, 2, GL_NEAREST)),
      light_(make_texture(gl, GL_RGBA32F, width_, height_, GL_NEAREST)),
      smoothed_(make_texture(gl, GL_RGBA32F, width_, height_, GL_NEAREST)),
      sky_target_(gl),
      light_target_(gl),
      smoothed_target_(gl),
      no_vertices_(gl) {
  gl.NamedFramebufferTexture(light_target_.name(), GL_COLOR_ATTACHMENT0, light_.name(), 0);
  gl.NamedFramebufferTexture(smoothed_target_.name(), GL_COLOR_ATTACHMENT0, smoothed_.name(), 0);
  for (const Framebuffer* target : {&light_target_, &smoothed_target_}) {
    check_framebuffer(gl, *target, "soft light");
  }
}

void SoftLight::draw_sky_maps(const SkyView& above, const SkyView& below, const DepthProgram& depth,
                              const DrawCasters& casters) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, sky_target_.name());
  gl_->Viewport(0, 0, kSkySize, kSkySize);
  for (int layer = 0; layer < 2; ++layer) {
    gl_->NamedFramebufferTextureLayer(sky_target_.name(), GL_DEPTH_ATTACHMENT, sky_.name(), 0, layer);
    depth.draw((layer == 0 ? above : below).clip_from_world, casters);
  }
}

void SoftLight::draw(const SkyView& above, const SkyView& below, const DepthProgram& depth,
                     const DrawCasters& casters) {
  gl_->Enable(GL_DEPTH_TEST);
  draw_sky_maps(above, below, depth, casters);

  gl_->Disable(GL_DEPTH_TEST);
  gl_->BindVertexArray(no_vertices_.name());
  gl_->BindFramebuffer(GL_FRAMEBUFFER, light_target_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->BindTextureUnit(6, sky_.name());
  soft_light_.use();
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);

  // Across, then down, ending where it began.
  blur_.use();
  for (const bool across : {true, false}) {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, (across ? smoothed_target_ : light_target_).name());
    gl_->BindTextureUnit(3, (across ? light_ : smoothed_).name());
    gl_->Uniform2i(blur_.uniform("axis"), across, !across);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_->BindTextureUnit(3, light_.name());
}

}  // namespace weft::render
