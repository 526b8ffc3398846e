// Pictures of surfaces as OpenGL samples them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "frame/frame_snapshot.hpp"
#include "render/gl/objects.hpp"
#include "render/opacity.hpp"

namespace weft::render {

/// One picture with all its sizes, made in linear light by the processor, so that means are those of light and no
/// colour comes from what is transparent; and its opacity where that cuts holes.
struct PaintTexture {
  Texture texture;
  std::optional<Opacity> opacity;
  std::shared_ptr<const frame::Texture> source;
};

class Paints {
 public:
  explicit Paints(const Gl& gl) : gl_(&gl) {}

  /// Made when first asked for; the paint has a picture.
  const PaintTexture& of(const frame::Paint& paint);

 private:
  using Key = std::tuple<const frame::Texture*, frame::Paint::Wrap, frame::Paint::Wrap, frame::Paint::Alpha>;
  const Gl* gl_;
  std::map<Key, PaintTexture> known_;
};

}  // namespace weft::render
