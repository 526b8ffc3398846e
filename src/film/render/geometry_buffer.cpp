#include "film/render/geometry_buffer.hpp"

#include <algorithm>
#include <string>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

/// Value of the uniform `paint_mode` of geometry.frag: how the picture of an appearance is applied.
int paint_mode_of(const frame::Paint& paint) {
  if (!paint.texture) return 1;
  if (paint.alpha == frame::Paint::Alpha::cutout) return 4;
  return covers_color(paint) ? 3 : 2;
}

// Maximum depth offset of refined cloth towards the viewer [m]. Parts of the curved triangles lie behind the simulated
// faces, by up to max_midpoint_offset(). Without the offset, surfaces below the cloth would be visible there. A
// midpoint is at most a quarter of its edge away from the straight edge (middle()). The offset has the same bound, so
// that small cloth does not cover surfaces in front of it.
constexpr double kMaxDepthOffset = 1.5e-3;
float depth_offset_of(const SurfaceBuffers& surface) {
  return surface.refined() ? static_cast<float>(std::min(kMaxDepthOffset, 0.25 * surface.longest_edge())) : 0.0f;
}

}  // namespace

GeometryBuffer::GeometryProgram::GeometryProgram(const Gl& gl, const Variant& variant) {
  std::vector<std::string> defines;
  if (variant.painted) defines.emplace_back("PAINTED");
  if (variant.pictured) defines.emplace_back("PICTURED");
  if (variant.holes) defines.emplace_back("HOLES");
  if (variant.trimmed) defines.emplace_back("TRIMMED");
  if (variant.peeled) defines.emplace_back("PEELED");
  if (variant.clipped) defines.emplace_back("CLIPPED");
  program = Program(gl, "geometry.vert", "geometry.frag", defines);
  surface = program.uniform("surface");
  depth_offset = program.uniform("depth_offset");
  picture_u = program.uniform("picture_u");
  picture_v = program.uniform("picture_v");
  paint_mode = program.uniform("paint_mode");
  color = program.uniform("color");
  back_color = program.uniform("back_color");
}

GeometryBuffer::Painting::Painting(const Gl& gl, int width, int height)
    : colors(make_texture(gl, GL_RGBA8, width, height, GL_NEAREST)), paints(gl) {}

GeometryBuffer::Layers::Layers(const Gl& gl, int width, int height)
    : peeled(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      seen(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      depth_stencil(make_texture(gl, GL_DEPTH32F_STENCIL8, width, height, GL_NEAREST)) {}

GeometryBuffer::GeometryBuffer(const Gl& gl, int width, int height, bool clips)
    : gl_(&gl),
      width_(width),
      height_(height),
      clips_(clips),
      normal_heat_(make_texture(gl, GL_RGBA32F, width, height, GL_NEAREST)),
      uv_(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      seen_(make_texture(gl, GL_RG32F, width, height, GL_NEAREST)),
      depth_stencil_(make_texture(gl, GL_DEPTH32F_STENCIL8, width, height, GL_NEAREST)),
      target_(gl) {
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, normal_heat_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT1, uv_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT2, seen_.name(), 0);
  gl.NamedFramebufferTexture(target_.name(), GL_DEPTH_STENCIL_ATTACHMENT, depth_stencil_.name(), 0);
  attach(false, false);
}

const GeometryBuffer::GeometryProgram& GeometryBuffer::use(const Variant& variant) {
  auto known = programs_.find(variant);
  if (known == programs_.end()) known = programs_.emplace(variant, GeometryProgram(*gl_, variant)).first;
  known->second.program.use();
  return known->second;
}

void GeometryBuffer::set_class(PixelClass pixel_class) const {
  gl_->StencilFunc(GL_ALWAYS, static_cast<GLint>(pixel_class), 0xFF);
}

void GeometryBuffer::begin(std::span<const SurfaceBuffers> surfaces) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->Enable(GL_DEPTH_TEST);
  gl_->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_->DepthFunc(GL_GREATER);
  gl_->Enable(GL_STENCIL_TEST);
  gl_->StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  const bool painted = std::ranges::any_of(surfaces, [](const SurfaceBuffers& each) { return each.painted(); });
  const bool trimmed = std::ranges::any_of(surfaces, [](const SurfaceBuffers& each) { return each.trimmed(); });
  if (painted != painted_ || trimmed != trimmed_) attach(painted, trimmed);
  // Value of attribute 5 (Trim::distance) for surfaces without trims.
  if (trimmed) gl_->VertexAttrib3f(5, kNoTrim, kNoTrim, kNoTrim);
}

void GeometryBuffer::end() {
  gl_->Disable(GL_STENCIL_TEST);
  gl_->BindTextureUnit(4, normal_heat_.name());
  gl_->BindTextureUnit(5, uv_.name());
  gl_->BindTextureUnit(8, seen_.name());
  if (painted_) gl_->BindTextureUnit(10, painting_->colors.name());
  if (trimmed_) gl_->BindTextureUnit(11, trims_.name());
}

void GeometryBuffer::draw(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out,
                          const FloorBuffers* floor, const Vec3& eye, double far) {
  begin(surfaces);
  const float nothing[] = {static_cast<float>(far), kNothing, 0, 0};
  gl_->ClearBufferfv(GL_COLOR, 2, nothing);
  gl_->ClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0f, static_cast<GLint>(PixelClass::backdrop));
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (!left_out.empty() && left_out[i] != 0) continue;
    set_class(surfaces[i].surface().kind == frame::ObjectKind::cloth ? PixelClass::cloth : PixelClass::solid);
    const bool cull = surfaces[i].shows_only_fronts(eye);
    if (cull) gl_->Enable(GL_CULL_FACE);
    draw(surfaces[i], static_cast<float>(kFirstSurface + i), false);
    if (cull) gl_->Disable(GL_CULL_FACE);
  }
  if (floor) {
    set_class(PixelClass::floor);
    const GeometryProgram& program = use({});
    gl_->Uniform1f(program.surface, kFloor);
    gl_->Uniform1f(program.depth_offset, 0);
    // The floor is invisible from below. It writes only distance and surface number.
    gl_->Enable(GL_CULL_FACE);
    for (const GLuint unused : {0, 1, 3, 4}) gl_->ColorMaski(unused, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    floor->draw();
    for (const GLuint unused : {0, 1, 3, 4}) gl_->ColorMaski(unused, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_->Disable(GL_CULL_FACE);
  }
  end();
}

void GeometryBuffer::draw_layer(std::span<const SurfaceBuffers> surfaces, std::span<const char> left_out, bool deeper) {
  if (!layers_) layers_.emplace(*gl_, width_, height_);
  // Each layer starts from the result of draw(). The call for the first layer saves this result.
  if (deeper) {
    copy(seen_, layers_->peeled);
    copy(layers_->seen, seen_);
    copy(layers_->depth_stencil, depth_stencil_);
  } else {
    const float none[] = {0, 0, 0, 0};
    gl_->ClearTexImage(layers_->peeled.name(), 0, GL_RG, GL_FLOAT, none);
    copy(seen_, layers_->seen);
    copy(depth_stencil_, layers_->depth_stencil);
  }
  begin(surfaces);
  const GLint backdrop = static_cast<GLint>(PixelClass::backdrop);
  gl_->ClearBufferiv(GL_STENCIL, 0, &backdrop);
  gl_->BindTextureUnit(12, layers_->peeled.name());
  set_class(PixelClass::cloth);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (left_out[i] != 0) draw(surfaces[i], static_cast<float>(kFirstSurface + i), true);
  end();
}

void GeometryBuffer::copy(const Texture& from, const Texture& to) const {
  gl_->CopyImageSubData(from.name(), GL_TEXTURE_2D, 0, 0, 0, 0, to.name(), GL_TEXTURE_2D, 0, 0, 0, 0, width_, height_,
                        1);
}

/// Attaches the textures of colours and of trims to the framebuffer only if a surface has colours or trims.
void GeometryBuffer::attach(bool painted, bool trimmed) {
  if (painted && !painting_) painting_.emplace(*gl_, width_, height_);
  if (trimmed && !trims_) trims_ = make_texture(*gl_, GL_RGBA32F, width_, height_, GL_NEAREST);
  painted_ = painted;
  trimmed_ = trimmed;
  gl_->NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT3, painted ? painting_->colors.name() : 0, 0);
  gl_->NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT4, trimmed ? trims_.name() : 0, 0);
  const GLenum outputs[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                            painted ? GLenum{GL_COLOR_ATTACHMENT3} : GLenum{GL_NONE},
                            trimmed ? GLenum{GL_COLOR_ATTACHMENT4} : GLenum{GL_NONE}};
  gl_->NamedFramebufferDrawBuffers(target_.name(), trimmed ? 5 : painted ? 4 : 3, outputs);
  check_framebuffer(*gl_, target_, "geometry buffer");
}

/// Draws one surface. If any surface of the picture is painted, the shaders of all surfaces write the paint of each
/// pixel; it is 0 for surfaces that are not painted.
void GeometryBuffer::draw(const SurfaceBuffers& surface, float number, bool peeled) {
  const auto use_for = [&](int paint_mode) -> const GeometryProgram& {
    const GeometryProgram& program = use({painted_, paint_mode >= 2, paint_mode == 4, trimmed_, peeled, clips_});
    gl_->Uniform1f(program.surface, number);
    gl_->Uniform1f(program.depth_offset, depth_offset_of(surface));
    gl_->Uniform1i(program.paint_mode, paint_mode);
    return program;
  };
  if (surface.painted() == nullptr) {
    use_for(0);
    return surface.draw();
  }
  for (const PaintedRange& range : surface.painted()->ranges) {
    const frame::Appearance& look = *range.look;
    const GeometryProgram& program = use_for(paint_mode_of(look.paint));
    const Eigen::Vector3f color = image::linear_from_srgb(look.color).cast<float>();
    const Eigen::Vector3f back = image::linear_from_srgb(look.back_color).cast<float>();
    const bool is_cloth = surface.surface().kind == frame::ObjectKind::cloth;
    const bool plain_back = is_cloth && (!look.paint.texture || !look.back_painted);
    gl_->Uniform3fv(program.color, 1, color.data());
    gl_->Uniform4f(program.back_color, back.x(), back.y(), back.z(),
                   plain_back ? -1.0f : (is_cloth ? static_cast<float>(look.back_paleness) : 0.0f));
    if (look.paint.texture) {
      const Eigen::Matrix<float, 2, 3> map = look.paint.texture_from_uv.cast<float>();
      gl_->Uniform3f(program.picture_u, map(0, 0), map(0, 1), map(0, 2));
      gl_->Uniform3f(program.picture_v, map(1, 0), map(1, 1), map(1, 2));
      gl_->BindTextureUnit(10, painting_->paints.of(look.paint).texture.name());
    }
    surface.draw(range);
  }
}

std::vector<const Opacity*> GeometryBuffer::opacity_of(const PaintedMesh& mesh) {
  std::vector<const Opacity*> list;
  for (const PaintedRange& range : mesh.ranges) {
    const bool cut = range.look->paint.texture && range.look->paint.alpha == frame::Paint::Alpha::cutout;
    if (cut && !painting_) painting_.emplace(*gl_, width_, height_);
    list.push_back(cut ? &*painting_->paints.of(range.look->paint).opacity : nullptr);
  }
  return list;
}

void GeometryBuffer::read_seen(std::vector<Seen>& seen) const {
  seen.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_->GetTextureImage(seen_.name(), 0, GL_RG, GL_FLOAT, static_cast<GLsizei>(seen.size() * sizeof(Seen)), seen.data());
}

void GeometryBuffer::read_normals(std::vector<Eigen::Vector4f>& normals) const {
  normals.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_->GetTextureImage(normal_heat_.name(), 0, GL_RGBA, GL_FLOAT,
                       static_cast<GLsizei>(normals.size() * sizeof(Eigen::Vector4f)), normals.data());
}

}  // namespace weft::render
