#include "render/ambient_occlusion.hpp"

#include <algorithm>

namespace weft::render {
namespace {

constexpr int kSkySize = 256;  // texels: the dark under things is soft anyway

}  // namespace

AmbientOcclusion::AmbientOcclusion(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      width_(std::max(1, width / quality.occlusion_divisor)),
      height_(std::max(1, height / quality.occlusion_divisor)),
      geometry_(gl, "geometry.vert", "geometry.frag"),
      occlusion_(gl, "fullscreen.vert", "occlusion.frag",
                 {"NEARBY_TAPS " + std::to_string(quality.nearby_taps), "SKY_TAPS " + std::to_string(quality.sky_taps)}),
      blur_(gl, "fullscreen.vert", "occlusion_blur.frag", {"RADIUS 2"}),
      depth_(make_texture(gl, GL_DEPTH_COMPONENT32F, width_, height_, GL_NEAREST)),
      normal_(make_texture(gl, GL_RGBA8, width_, height_, GL_NEAREST)),
      sky_(make_texture_array(gl, GL_DEPTH_COMPONENT32F, kSkySize, kSkySize, 2, GL_NEAREST)),
      openness_(make_texture(gl, GL_RGBA32F, width_, height_, GL_NEAREST)),
      smoothed_(make_texture(gl, GL_RGBA32F, width_, height_, GL_NEAREST)),
      sky_target_(gl),
      geometry_target_(gl),
      openness_target_(gl),
      smoothed_target_(gl),
      no_vertices_(gl) {
  gl.NamedFramebufferTexture(geometry_target_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  gl.NamedFramebufferTexture(geometry_target_.name(), GL_COLOR_ATTACHMENT0, normal_.name(), 0);
  gl.NamedFramebufferTexture(openness_target_.name(), GL_COLOR_ATTACHMENT0, openness_.name(), 0);
  gl.NamedFramebufferTexture(smoothed_target_.name(), GL_COLOR_ATTACHMENT0, smoothed_.name(), 0);
  for (const Framebuffer* target : {&geometry_target_, &openness_target_, &smoothed_target_}) {
    check_framebuffer(gl, *target, "ambient occlusion");
  }
}

void AmbientOcclusion::draw_sky_maps(const SkyView& above, const SkyView& below, const DepthProgram& depth,
                                     const DrawCasters& casters) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, sky_target_.name());
  gl_->Viewport(0, 0, kSkySize, kSkySize);
  gl_->Enable(GL_DEPTH_TEST);
  for (int layer = 0; layer < 2; ++layer) {
    gl_->NamedFramebufferTextureLayer(sky_target_.name(), GL_DEPTH_ATTACHMENT, sky_.name(), 0, layer);
    depth.draw((layer == 0 ? above : below).clip_from_world, casters);
  }
}

void AmbientOcclusion::draw(const SkyView& above, const SkyView& below, const DepthProgram& depth,
                            const DrawCasters& casters, const DrawCasters& draw_geometry) {
  draw_sky_maps(above, below, depth, casters);

  gl_->BindFramebuffer(GL_FRAMEBUFFER, geometry_target_.name());
  gl_->Viewport(0, 0, width_, height_);
  const float far = 1.0f;
  gl_->ClearBufferfv(GL_DEPTH, 0, &far);
  geometry_.use();
  draw_geometry();

  gl_->Disable(GL_DEPTH_TEST);
  gl_->BindVertexArray(no_vertices_.name());
  for (const GLuint unit : {0u, 1u, 2u, 3u}) gl_->BindSampler(unit, 0);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, openness_target_.name());
  gl_->BindTextureUnit(0, depth_.name());
  gl_->BindTextureUnit(1, normal_.name());
  gl_->BindTextureUnit(2, sky_.name());
  occlusion_.use();
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);

  // Across, then down, ending where it began.
  blur_.use();
  for (const bool across : {true, false}) {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, (across ? smoothed_target_ : openness_target_).name());
    gl_->BindTextureUnit(0, (across ? openness_ : smoothed_).name());
    gl_->Uniform2i(blur_.uniform("axis"), across, !across);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_->BindTextureUnit(3, openness_.name());
}

}  // namespace weft::render
