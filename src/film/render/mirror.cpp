#include "film/render/mirror.hpp"

#include <bit>

namespace weft::render {
namespace {

constexpr int kDivisor = 2;  // side of a pixel of the reflection [pixels of the picture]

/// Settings for reflections: because they are blurred, shadows and surroundings are traced at points twice as far
/// apart.
QualitySettings reflection_quality(QualitySettings quality) {
  quality.shadow_divisor *= kDivisor;
  quality.ambient_divisor *= kDivisor;
  return quality;
}

}  // namespace

View mirror_view(const View& view, const Floor& floor) {
  const Vec3 n = floor.normal;
  const auto reflect = [&](const Vec3& v) -> Vec3 { return v - 2 * n.dot(v) * n; };
  View mirror = view;
  mirror.eye = floor.point + reflect(view.eye - floor.point);
  // A reflection makes the axes left-handed. Negating `up` makes them right-handed again, and the picture upside down.
  mirror.axes = {reflect(view.axes.right), -reflect(view.axes.up), reflect(view.axes.forward)};
  mirror.view_from_world = look_along(mirror.eye, mirror.axes);
  mirror.clip_from_world = perspective(view.tan_half_width, view.tan_half_height, view.near) * mirror.view_from_world;
  return mirror;
}

Mirror::Mirror(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      width_((width + kDivisor - 1) / kDivisor),
      height_((height + kDivisor - 1) / kDivisor),
      geometry_(gl, width_, height_, true),
      traced_light_(gl, reflection_quality(quality), width_, height_),
      shading_(gl, quality, width_, height_, geometry_),
      frame_block_(gl),
      picture_(gl, GLenum{GL_TEXTURE_2D}) {
  const int levels = std::bit_width(static_cast<unsigned>(std::max(width_, height_)));
  gl.TextureStorage2D(picture_.name(), levels, GL_RGBA16, width_, height_);
  set_sampling(gl, picture_, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
}

void Mirror::draw(const View& view, const FrameUniform& block, const Subjects& subjects, const LightSet& lights) {
  gl_->NamedBufferData(frame_block_.name(), sizeof(block), &block, GL_STREAM_DRAW);
  gl_->BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  // Clips surfaces below the floor, because the floor does not reflect them.
  gl_->Enable(GL_CLIP_DISTANCE0);
  geometry_.draw(subjects.surfaces, {}, nullptr, view.eye, view.far);
  gl_->Disable(GL_CLIP_DISTANCE0);
  geometry_.read_seen(seen_);
  traced_light_.draw(subjects.light, geometry_, seen_, subjects.traced, view, std::nullopt);
  const Shading::Features features{
      .lights = lights, .painted = subjects.painted && geometry_.painted(), .trimmed = geometry_.trimmed()};
  shading_.draw(subjects.materials, subjects.heat_scale, features, {0, 0, width_, height_}, {});
  gl_->CopyImageSubData(shading_.picture().name(), GL_TEXTURE_2D, 0, 0, 0, 0, picture_.name(), GL_TEXTURE_2D, 0, 0, 0,
                        0, width_, height_, 1);
  gl_->GenerateTextureMipmap(picture_.name());
  gl_->BindTextureUnit(13, picture_.name());
  gl_->BindTextureUnit(14, geometry_.seen().name());
}

}  // namespace weft::render
