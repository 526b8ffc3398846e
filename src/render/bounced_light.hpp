// One bounce of indirect light between surfaces and floor: a red sheet above a floor tints both.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/gl/objects.hpp"
#include "render/shadow_maps.hpp"
#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

/// A small area of surface that emits light towards the side of its normal.
struct LitPatch {
  Eigen::Vector3f position, normal;  ///< [m]; unit length
  float area = 0;                    ///< [m²]
  Eigen::Vector3f light;  ///< radiance, linear; negative where a patch has less light than is counted elsewhere
  Eigen::Vector3f color;  ///< albedo: fraction of the incident light that it reflects, linear
  bool hides = true;      ///< blocks the surroundings behind it; false for the floor, which is part of them
};

/// Regular grid of cubic cells that fills a box.
struct BounceGrid {
  Eigen::Vector3f first;  ///< centre of the first cell [m]
  float cell = 1;         ///< side of a cell [m]
  Eigen::Array3i counts;  ///< along x, y, z

  /// Grid around `subjects` and a margin, with about `cell_count` cells (cells that rounding adds are not counted).
  /// Cells lie at multiples of their side, and each doubling has only eight sides, so that the light does not flicker
  /// if a moving subject changes the box.
  BounceGrid(const Box3& subjects, int cell_count);
  std::size_t size() const { return static_cast<std::size_t>(counts.prod()); }
  /// Centre of a cell [m]. Cells below the floor use a point just above it.
  Eigen::Vector3f middle(const Eigen::Array3i& place, const std::optional<Floor>& floor) const;
};

/// Irradiance from the patches at the centre of each cell, as the light that matte white shows, and in w the fraction
/// of its surroundings that they hide. Directions +x, -x, +y, -y, +z, -z in turn; zero in the outermost cells. Cells
/// below the floor use a point just above it. `passes`: fraction of a patch's light that reaches a point.
std::vector<Eigen::Vector4f> gather(const BounceGrid& grid, std::span<const LitPatch> patches,
                                    const std::optional<Floor>& floor,
                                    const std::function<float(const LitPatch&, const Eigen::Vector3f&)>& passes);

/// One surface with its appearance.
struct BouncingSurface {
  const SurfaceBuffers* surface;
  const frame::Appearance* look;
  bool plain;     ///< ignores the colours of parts and pictures
  float opacity;  ///< fraction of light that it stops
};

class BouncedLight {
 public:
  BouncedLight(const Gl& gl, int cells);

  /// Shadow maps must be drawn. Binds the result to texture unit 15 and uniform block 2 (shaders/bounced_light.glsl).
  void draw(std::span<const BouncingSurface> surfaces, const std::optional<Floor>& floor, double floor_tint,
            const Irradiance& around, const Box3& subjects, const ShadowMaps& shadows);

 private:
  Eigen::Vector3f color_of(const frame::Appearance& look, bool back);

  const Gl* gl_;
  int cells_;  // approximate number of cells
  Texture light_;
  Eigen::Array3i counts_ = Eigen::Array3i::Zero();  // cells of `light_`
  Buffer block_;
  std::map<std::shared_ptr<const frame::Texture>, Eigen::Vector3f> means_;  // mean colours of pictures, linear
};

}  // namespace weft::render
