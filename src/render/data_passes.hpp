// What is seen at the centre of each pixel, in figures: what compositors ask for beside the picture.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "image/exr.hpp"
#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

/// A frame before, and how it was seen.
struct Before {
  const frame::FrameSnapshot& snapshot;
  View view;

  /// Of a surface of this name with as many vertices; null where there was none.
  const std::vector<Vec3>* positions(const frame::Surface& surface, std::size_t count) const;
};

/// Works on the processor, in double precision: the triangle in front is found as shadow maps find it, and the ray of
/// the pixel then meets that one exactly. Lace counts as solid.
class DataPasses {
 public:
  DataPasses(int width, int height) : width_(width), height_(height) {}

  /// Appends to `layers`, as 32 bits:
  /// - depth.Z: distance along the view axis [m]; infinite where nothing is
  /// - position.X, .Y, .Z: world [m]; normal.X, .Y, .Z: world, unit, toward the viewer
  /// - id.object: 0 nothing, 1 the floor, 2 + i surface i of the picture; id.part: 1 + i part i of that, else 0
  /// - uv.U, .V: rest coordinates (weft, warp) [m]
  /// - motion.X, .Y: to here from where the point was `before` [pixels, to the right and up]; 0 where that is not
  ///   there
  /// - heat.V: strain or speed, where the stage asks for either
  void draw(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
            const std::optional<Before>& before, image::Layers& layers);

 private:
  struct Hit {
    float nearness = 0;  // 1 / distance [1/m]
    std::int32_t surface = -1, triangle = -1;
  };
  void find(std::span<const SurfaceBuffers> surfaces, const View& view);
  Vec2 to_picture(const View& view, const Vec3& position) const;

  int width_, height_;
  std::vector<Hit> hits_;  // lowest row first
};

}  // namespace weft::render
