#include "render/outlines.hpp"

namespace weft::render {

Outlines::Outlines(const Gl& gl, int width, int height, int samples)
    : gl_(&gl),
      width_(width),
      height_(height),
      inside_(gl, "fullscreen.vert", "inside.frag"),
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

void Outlines::draw_surface(const SurfaceBuffers& surface, const View& view, const OutlineTiles& tiles) const {
  // Pixel coordinates of all vertices; those not in front of the viewer take any triangle in.
  constexpr float kFar = 1e9f;
  std::vector<Eigen::Array2f> low, high;
  for (const Vec3& position : surface.positions()) {
    const Eigen::Vector4d clip = view.clip_from_world * position.homogeneous();
    const bool in_front = clip.w() > view.near;
    const Eigen::Array2f pixel(static_cast<float>((0.5 + 0.5 * clip.x() / clip.w()) * width_),
                               static_cast<float>((0.5 + 0.5 * clip.y() / clip.w()) * height_));
    low.push_back(in_front ? Eigen::Array2f(pixel - 1) : Eigen::Array2f::Constant(-kFar));
    high.push_back(in_front ? Eigen::Array2f(pixel + 1) : Eigen::Array2f::Constant(kFar));
  }
  surface.draw_some([&](Index a, Index b, Index c) {
    const Eigen::Array2f least = low[a].min(low[b]).min(low[c]), most = high[a].max(high[b]).max(high[c]);
    return tiles.any(least.x(), least.y(), most.x(), most.y());
  });
}

void Outlines::draw(std::span<const SurfaceBuffers> surfaces, const FloorBuffers* floor, const GeometryBuffer& geometry,
                    const Texture& shaded, const View& view, const PixelArea& area) {
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
  gl_->BindTextureUnit(9, shaded.name());
  gl_->BindVertexArray(no_vertices_.name());
  inside_.use();
  gl_->DepthRange(0, 0);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->DepthRange(0, 1);
  surface_.use();
  // Small triangles cost several times more with four samples, and most of them lie inside.
  const OutlineTiles tiles(geometry.read_distances(), width_, height_);
  for (const SurfaceBuffers& surface : surfaces) draw_surface(surface, view, tiles);
  if (floor) {
    gl_->Enable(GL_CULL_FACE);
    floor->draw();
    gl_->Disable(GL_CULL_FACE);
  }
  rest_.use();
  gl_->Uniform1f(rest_.uniform("rest_distance"), static_cast<float>(view.far));
  gl_->BindVertexArray(no_vertices_.name());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->Disable(GL_SCISSOR_TEST);
  const GLint right = area.x + area.width, top = area.y + area.height;
  gl_->NamedFramebufferTexture(resolved_.name(), GL_COLOR_ATTACHMENT0, shaded.name(), 0);
  gl_->BlitNamedFramebuffer(target_.name(), resolved_.name(), area.x, area.y, right, top, area.x, area.y, right, top,
                            GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace weft::render
