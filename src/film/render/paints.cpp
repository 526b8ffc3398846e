#include "film/render/paints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

using Wrap = frame::Paint::Wrap;
using Alpha = frame::Paint::Alpha;

// GL_TEXTURE_MAX_ANISOTROPY of OpenGL 4.6, which llvmpipe supports as an extension. With the value 8, pictures on cloth
// are sharp down to an angle of 7 degrees between cloth and line of sight.
constexpr GLenum kMaxAnisotropy = 0x84FE;
constexpr float kAnisotropy = 8;

GLint gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return GL_REPEAT;
    case Wrap::clamp:
      return GL_CLAMP_TO_EDGE;
    case Wrap::mirror:
      return GL_MIRRORED_REPEAT;
    case Wrap::once:
      return GL_CLAMP_TO_BORDER;  // the border is transparent
  }
  return GL_REPEAT;
}

/// Converts linear light to a byte of an sRGB texture, with an error below one level of 255.
std::uint8_t srgb_byte(float linear) {
  constexpr int kSteps = 8192;  // table entries; adjacent bytes are 2.5 entries apart near black, more elsewhere
  static const auto kTable = [] {
    std::vector<std::uint8_t> table;
    for (int i = 0; i <= kSteps; ++i)
      table.push_back(static_cast<std::uint8_t>(std::lround(255 * image::srgb_from_linear(double(i) / kSteps))));
    return table;
  }();
  return kTable[static_cast<std::size_t>(std::lround(kSteps * std::clamp(linear, 0.0f, 1.0f)))];
}

std::vector<std::uint8_t> bytes_of(const MipLevel& level) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * level.texels.size());
  for (const Eigen::Vector4f& texel : level.texels) {
    for (int channel = 0; channel < 3; ++channel) bytes.push_back(srgb_byte(texel[channel]));
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(texel.w(), 0.0f, 1.0f))));
  }
  return bytes;
}

}  // namespace

const PaintTexture& Paints::of(const frame::Paint& paint) {
  const Key key{paint.texture.get(), paint.wrap_u, paint.wrap_v, paint.alpha};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  std::vector<MipLevel> levels{base_mip_level(*paint.texture, paint.alpha == Alpha::ignored)};
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(next_mip_level(levels.back()));

  PaintTexture made;
  made.source = paint.texture;
  made.texture = Texture(*gl_, GLenum{GL_TEXTURE_2D});
  const GLuint name = made.texture.name();
  gl_->TextureStorage2D(name, static_cast<GLsizei>(levels.size()), GL_SRGB8_ALPHA8, levels[0].width, levels[0].height);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::vector<std::uint8_t> bytes = bytes_of(levels[i]);
    gl_->TextureSubImage2D(name, static_cast<GLint>(i), 0, 0, levels[i].width, levels[i].height, GL_RGBA,
                           GL_UNSIGNED_BYTE, bytes.data());
  }
  set_sampling(*gl_, made.texture, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, gl_wrap(paint.wrap_u), gl_wrap(paint.wrap_v));
  check_errors(*gl_, "uploading a picture");
  gl_->TextureParameterf(name, kMaxAnisotropy, kAnisotropy);
  gl_->GetError();  // clears the error if OpenGL has no anisotropic filtering
  if (paint.alpha == Alpha::cutout) made.opacity.emplace(std::move(levels), paint.wrap_u, paint.wrap_v);
  return known_.emplace(key, std::move(made)).first->second;
}

}  // namespace weft::render
