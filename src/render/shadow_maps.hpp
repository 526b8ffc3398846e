// Depth maps of each light, with coarse depth ranges that spare most pixels the filtering.
#pragma once

#include <span>
#include <vector>

#include "render/gl/objects.hpp"
#include "render/lighting.hpp"
#include "render/quality.hpp"
#include "render/shaded_mesh.hpp"

namespace weft::render {

class ShadowMaps {
 public:
  ShadowMaps(const Gl& gl, const QualitySettings& quality);

  /// Draws the map of every light and uploads the light block. Binds the maps to units 0 to 2. They contain what is
  /// `in_view`; null: all casters.
  void draw(std::span<const frame::Light> lights, std::span<const Vec3> caster_positions,
            std::span<const DrawnMesh> casters, const InView* in_view, const Vec3& up, const Vec3& scale);

  /// Direct light on matte white at a point that faces `normal`, in view or not. `shadowed`: with hard shadows, else
  /// without. Call after draw().
  Eigen::Vector3f light_on(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, bool shadowed) const;

  /// Macro definitions for shaders that include lights.glsl.
  static std::vector<std::string> defines(const QualitySettings& quality, const LightSet& lights);

 private:
  /// Minimum and maximum depth in a block of texels; outside the range [0, 1] without a caster, as nothing is dark
  /// there.
  struct Range {
    float nearest = 1, farthest = 0;
  };
  struct Map {
    LightUniform light;
    int size = 0;
    std::vector<float> depths;  // 1 where no caster is
  };
  void reserve(int layers);
  void find_ranges(std::span<const float> map);
  void spread_ranges(int step, int other_step);

  const Gl* gl_;
  QualitySettings quality_;
  int layers_ = 0;
  Texture depth_, range_;
  Sampler compare_, raw_;
  Buffer light_block_;
  std::vector<Map> maps_,
      complete_maps_;  // per light; complete_maps_: coarse maps of all casters, filled if maps_ omit some
  std::vector<Range> ranges_;
};

}  // namespace weft::render
