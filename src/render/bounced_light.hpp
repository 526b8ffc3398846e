// Light that surfaces and floor throw on each other, once: where a red sheet hangs over a floor both show it.
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

/// A piece of surface that sends light to the side of its normal.
struct LitPatch {
  Eigen::Vector3f position, normal;  ///< [m]; unit length
  float area = 0;                    ///< [m²]
  Eigen::Vector3f light;             ///< that it shows, linear; negative: less than is counted elsewhere
  Eigen::Vector3f color;             ///< share of the light on it that it shows
  bool hides = true;                 ///< what is behind it; floor is part of the surroundings
};

/// Cubes that fill a box.
struct BounceGrid {
  Eigen::Vector3f first;  ///< middle of the first [m]
  float cell = 1;         ///< side [m]
  Eigen::Array3i counts;  ///< along x, y, z

  /// About a box, of about `most` cells, those for their margin aside. Cells lie at multiples of their side, of
  /// which there are eight for each doubling, so that the light does not flicker while what moves changes the box.
  BounceGrid(const Box3& subjects, int most);
  std::size_t size() const { return static_cast<std::size_t>(counts.prod()); }
  /// Of a cell; those below the floor are taken right above it.
  Eigen::Vector3f middle(const Eigen::Array3i& place, const std::optional<Floor>& floor) const;
};

/// Light that matte white takes from the patches in the middle of each cell, and what share of its surroundings they
/// hide, facing +x, -x, +y, -y, +z, -z in turn; zero in the outermost. Cells below the floor are taken as right above
/// it. `passes`: share of a patch's light that gets to a place.
std::vector<Eigen::Vector4f> gather(const BounceGrid& grid, std::span<const LitPatch> patches,
                                    const std::optional<Floor>& floor,
                                    const std::function<float(const LitPatch&, const Eigen::Vector3f&)>& passes);

/// One surface with what it shows.
struct BouncingSurface {
  const SurfaceBuffers* surface;
  const frame::Appearance* look;
  bool plain;     ///< parts and pictures have no colours of their own
  float opacity;  ///< share of light that it stops
};

class BouncedLight {
 public:
  BouncedLight(const Gl& gl, int cells);

  /// Expects the shadow maps drawn. Leaves the result bound to unit 15 and uniform block 2; shaders/bounced_light.glsl.
  void draw(std::span<const BouncingSurface> surfaces, const std::optional<Floor>& floor, double floor_tint,
            const Irradiance& around, const Box3& subjects, const ShadowMaps& shadows);

 private:
  Eigen::Vector3f color_of(const frame::Appearance& look, bool back);

  const Gl* gl_;
  int cells_;  // at about most
  Texture light_;
  Eigen::Array3i counts_ = Eigen::Array3i::Zero();  // of cells that it has
  Buffer block_;
  std::map<std::shared_ptr<const frame::Texture>, Eigen::Vector3f> means_;  // of pictures, linear
};

}  // namespace weft::render
