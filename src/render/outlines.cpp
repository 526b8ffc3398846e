#include "render/outlines.hpp"

namespace weft::render {

Outlines::Outlines(const Gl& gl, int width, int height, int samples)
    : gl_(&gl),
      width_(width),
      height_(height),
      surface_(gl, "geometry.vert", "edges.frag"),
      rest_(gl, "fullscreen.vert", "edges.frag", {"REST"}),
      color_(make_multisample_texture(gl, GL_RGBA8, width, height, samples)),
      depth_(make_multisample_texture(gl, GL_DEPTH_COMPONENT24, width, height, samples)),
      target_(gl),
      resolved_(gl),
      no_vertices_(gl) {
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  check_framebuffer(gl, target_, "outlines");
}

void Outlines::draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const Texture& shaded,
                    const PixelArea& area, double far) {
  if (area.width <= 0 || area.height <= 0) return;
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  // All that has outlines lies in the area, often less than half of the picture.
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(area.x, area.y, area.width, area.height);
  const float nothing = 1.0f;
  gl_->ClearBufferfv(GL_DEPTH, 0, &nothing);
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LEQUAL);
  gl_->BindTextureUnit(8, shaded.name());
  surface_.use();
  for (const SurfaceBuffers& surface : surfaces) surface.draw();
  if (floor) {
    gl_->Enable(GL_CULL_FACE);
    floor->draw();
    gl_->Disable(GL_CULL_FACE);
  }
  rest_.use();
  gl_->Uniform1f(rest_.uniform("rest_distance"), static_cast<float>(far));
  gl_->BindVertexArray(no_vertices_.name());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->Disable(GL_SCISSOR_TEST);
  const GLint right = area.x + area.width, top = area.y + area.height;
  gl_->NamedFramebufferTexture(resolved_.name(), GL_COLOR_ATTACHMENT0, shaded.name(), 0);
  gl_->BlitNamedFramebuffer(target_.name(), resolved_.name(), area.x, area.y, right, top, area.x, area.y, right, top,
                            GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace weft::render
