// Numeric passes for compositors: depth, position, normal, ids and motion at the centre of each pixel.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "film/image/exr.hpp"
#include "film/render/surface_buffers.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// An earlier frame, and the view from which it was drawn.
struct EarlierFrame {
  const frame::FrameSnapshot& snapshot;
  View view;
};

/// Finds the nearest triangle of each pixel by rasterising on the CPU in single precision. Then
/// intersects the pixel's ray with the plane of this triangle in double precision. Holes that
/// pictures cut into a surface (as in lace) count as part of the surface.
class DataPasses {
 public:
  DataPasses(int width, int height) : width_(width), height_(height) {}

  /// Appends these channels to `layers`, as 32-bit floats:
  /// - depth.Z: distance along the view axis [m]; infinite if the pixel shows nothing
  /// - position.X, .Y, .Z: world [m]; normal.X, .Y, .Z: world, unit, of the visible side; 0 if the pixel shows nothing
  /// - id.object: 0 for nothing, 1 for the floor, 2 + i for surface i of the picture; id.part: 1 + k for part k of that
  ///   surface, 0 if it has no parts
  /// - uv.U, .V: Surface::uv (weft, warp) [m]; 0 if the surface has none
  /// - motion.X, .Y: displacement of the point since `before` [pixels, right and up], including the
  ///   motion of the camera; a surface that find_positions() does not find in `before` counts as unmoved; 0
  ///   if `before` is absent, for the backdrop, and for points that were behind the camera
  /// - heat.V: strain or speed (Stage::heat), only if a surface has heat values
  void draw(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
            const std::optional<EarlierFrame>& before, image::Layers& layers);

 private:
  struct Hit {
    float nearness = 0;  // 1 / distance [1/m]
    std::int32_t surface = -1, triangle = -1;
  };
  void find_hits(std::span<const SurfaceBuffers> surfaces, const View& view);
  std::optional<Vec2> to_picture(const View& view, const Vec3& position) const;

  int width_, height_;
  std::vector<Hit> hits_;  // lowest row first
};

}  // namespace weft::render
