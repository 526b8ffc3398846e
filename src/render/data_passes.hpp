// Numeric passes for compositors: depth, position, normal, ids and motion at the centre of each pixel.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "image/exr.hpp"
#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

/// An earlier frame and the view that it was drawn from.
struct Before {
  const frame::FrameSnapshot& snapshot;
  View view;

  /// Positions of the surface with the same name and `count` vertices; null if there was none.
  const std::vector<Vec3>* positions(const frame::Surface& surface, std::size_t count) const;
};

/// Rasterises on the CPU in single precision to find the front triangle of each pixel, then intersects the ray of the
/// pixel with its plane in double precision. Holes of pictures with an alpha channel (lace) count as cloth.
class DataPasses {
 public:
  DataPasses(int width, int height) : width_(width), height_(height) {}

  /// Appends to `layers`, as 32-bit floats:
  /// - depth.Z: distance along the view axis [m]; infinite where nothing is visible
  /// - position.X, .Y, .Z: world [m]; normal.X, .Y, .Z: world, unit, towards the viewer
  /// - id.object: 0 nothing, 1 the floor, 2 + i surface i of the picture; id.part: 1 + i part i of that surface, else 0
  /// - uv.U, .V: rest coordinates (weft, warp) [m]
  /// - motion.X, .Y: displacement of the point since `before` [pixels, right and up], motion of the camera included; a
  ///   surface that did not exist then counts as still
  /// - heat.V: strain or speed, if Stage::heat selects one; otherwise there is no such layer
  void draw(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
            const std::optional<Before>& before, image::Layers& layers);

 private:
  struct Hit {
    float nearness = 0;  // 1 / distance [1/m]
    std::int32_t surface = -1, triangle = -1;
  };
  void find_hits(std::span<const SurfaceBuffers> surfaces, const View& view);
  Vec2 to_picture(const View& view, const Vec3& position) const;

  int width_, height_;
  std::vector<Hit> hits_;  // lowest row first
};

}  // namespace weft::render
