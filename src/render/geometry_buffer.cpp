#include "render/geometry_buffer.hpp"

namespace weft::render {

GeometryBuffer::GeometryBuffer(const Gl& gl, int width, int height)
    : gl_(&gl),
      width_(width),
      height_(height),
      program_(gl, "geometry.vert", "geometry.frag"),
      surface_(program_.uniform("surface")),
      normal_heat_(make_texture(gl, GL_RGBA32F, width, height, GL_NEAREST)),
      uv_(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      seen_(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      depth_stencil_(make_texture(gl, GL_DEPTH24_STENCIL8, width, height, GL_NEAREST)),
      target_(gl) {
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, normal_heat_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT1, uv_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT2, seen_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_STENCIL_ATTACHMENT, depth_stencil_.name(), 0);
  const GLenum outputs[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  gl.NamedFramebufferDrawBuffers(target_.name(), 3, outputs);
  check_framebuffer(gl, target_, "geometry buffer");
}

void GeometryBuffer::set_class(PixelClass pixel_class) const {
  gl_->StencilFunc(GL_ALWAYS, static_cast<GLint>(pixel_class), 0xFF);
}

void GeometryBuffer::draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const Vec3& eye,
                          double far) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  const float nothing[] = {static_cast<float>(far), kNothing, 0, 0};
  gl_->ClearBufferfv(GL_COLOR, 2, nothing);
  gl_->ClearBufferfi(GL_DEPTH_STENCIL, 0, 1.0f, static_cast<GLint>(PixelClass::backdrop));
  gl_->Enable(GL_DEPTH_TEST);
  gl_->Enable(GL_STENCIL_TEST);
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  program_.use();
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    set_class(surfaces[i].surface().kind == frame::ObjectKind::cloth ? PixelClass::cloth : PixelClass::solid);
    gl_->Uniform1f(surface_, static_cast<float>(kFirstSurface + i));
    const bool cull = surfaces[i].hides_its_backs(eye);
    if (cull) gl_->Enable(GL_CULL_FACE);
    surfaces[i].draw();
    if (cull) gl_->Disable(GL_CULL_FACE);
  }
  if (floor) {
    set_class(PixelClass::floor);
    gl_->Uniform1f(surface_, kFloor);
    // From below one looks through the floor. Its normal is that of a plane, and it has no rest coordinates.
    gl_->Enable(GL_CULL_FACE);
    for (const GLuint unused : {0, 1}) gl_->ColorMaski(unused, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    floor->draw();
    for (const GLuint unused : {0, 1}) gl_->ColorMaski(unused, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_->Disable(GL_CULL_FACE);
  }
  gl_->Disable(GL_STENCIL_TEST);
  gl_->BindTextureUnit(4, normal_heat_.name());
  gl_->BindTextureUnit(5, uv_.name());
  gl_->BindTextureUnit(8, seen_.name());
}

void GeometryBuffer::read_seen(std::vector<Seen>& seen) const {
  seen.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_->GetTextureImage(seen_.name(), 0, GL_RG, GL_FLOAT, static_cast<GLsizei>(seen.size() * sizeof(Seen)), seen.data());
}

}  // namespace weft::render
