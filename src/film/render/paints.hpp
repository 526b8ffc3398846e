// Pictures on surfaces as OpenGL textures.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/gl/objects.hpp"
#include "film/render/opacity.hpp"

namespace weft::render {

/// One picture with all mip levels, and its opacity if it cuts holes. The CPU computes the mip levels from
/// premultiplied linear colour, so that they are averages of light, to which transparent texels contribute nothing.
struct PaintTexture {
  Texture texture;
  std::optional<Opacity> opacity;
  std::shared_ptr<const frame::Texture> source;
};

/// The textures of all paints of a context.
class Paints {
 public:
  explicit Paints(const Gl& gl) : gl_(&gl) {}

  /// The texture of a paint, made on first use. `paint` must have a picture (`texture`).
  const PaintTexture& of(const frame::Paint& paint);

 private:
  using Key = std::tuple<const frame::Texture*, frame::Paint::Wrap, frame::Paint::Wrap, frame::Paint::Alpha>;
  const Gl* gl_;
  std::map<Key, PaintTexture> known_;
};

}  // namespace weft::render
