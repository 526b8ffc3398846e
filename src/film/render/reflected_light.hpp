// The light that arrives along a ray: light of lamps and surroundings, reflected by the surface that the ray hits.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/lamps.hpp"
#include "film/render/ray_scene.hpp"
#include "film/render/surface_buffers.hpp"
#include "film/render/surroundings.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// Fraction of the area of a painted range that the picture of its appearance covers; 1 if there is no picture. A
/// triangle is covered if its middle is inside the picture along each axis with Wrap::once. `triangles`, `positions`:
/// of the drawn mesh.
double covered_fraction(const PaintedMesh& painted, const PaintedRange& range, std::span<const Triangle> triangles,
                        std::span<const Vec3> positions);

/// Computes mean linear colours of appearances, of the front or of the `back`. In pictures with transparency, each
/// pixel counts in proportion to its opacity; with Alpha::over_color, the colour of the surface has the rest. Each
/// picture is averaged only once. `fraction`: covered_fraction(), for pictures that cover the colour
/// (frame::Appearance::paint). The back with a picture has the mean colour of the front, paler by back_paleness.
class MeanColors {
 public:
  Eigen::Vector3f of(const frame::Appearance& look, bool back, double fraction = 1);

 private:
  struct Mean {
    Eigen::Vector3f color = Eigen::Vector3f::Zero();  // weighted by opacity
    float opacity = 0;
  };
  std::map<std::pair<std::shared_ptr<const frame::Texture>, bool>, Mean> means_;  // bool: its transparency is ignored
};

/// Albedo of both sides of a surface, by ranges of its drawn triangles.
struct ReflectingSurface {
  struct Range {
    std::size_t end;  ///< index of the last triangle, plus 1
    Eigen::Vector3f front, back;
  };
  std::vector<Range> ranges;  ///< the last range also covers all further triangles
};

/// Albedo of a surface. `look`: appearance of the whole surface. `plain`: all parts have the appearance `look`. `dark`:
/// all colours are black.
ReflectingSurface reflecting_surface(const SurfaceBuffers& surface, const frame::Appearance& look, bool plain,
                                     bool dark, MeanColors& colors);

/// Lamps, surroundings and albedo of a picture, from which the light along rays follows.
class ReflectedLight {
 public:
  /// `surfaces`: one per mesh of `rays`, in the same order. `floor_color`: linear. `scene_size`: see ray_start() [m].
  ReflectedLight(const RayScene& rays, std::vector<ReflectingSurface> surfaces, std::vector<Lamp> lamps,
                 const Irradiance& around, const std::optional<Floor>& floor, const Eigen::Vector3f& floor_color,
                 double scene_size = 1);

  const RayScene& rays() const { return *rays_; }
  std::span<const Lamp> lamps() const { return lamps_; }

  /// Rays that leave a surface at `points` start at these distances from it [m]: more than rounding errors, which grow
  /// with the distance from the origin, less than the gap between layers of cloth, which is smaller in small scenes.
  Lanes ray_start(const Lanes3& points) const;

  struct Arriving {
    Lanes open = Lanes::Zero();  ///< 1 if the ray hits no surface; the floor counts as part of the surroundings
    /// The radiance along the ray is `open` times that of the surroundings, plus `light`. If the ray hits a surface,
    /// `light` is all of the radiance. The surroundings contain the floor, fully lit by suns but not by spots. If the
    /// ray hits the floor, `light` is the difference: negative in the shadow of a sun, positive in the light of a spot.
    Lanes3 light;
  };
  Arriving arriving(const Rays& rays) const;

 private:
  Lanes3 surroundings(const Lanes3& normal) const;

  const RayScene* rays_;
  std::vector<ReflectingSurface> surfaces_;
  std::vector<Lamp> lamps_;
  std::array<Eigen::Vector3f, 9> around_;
  bool has_floor_;
  Eigen::Vector3f floor_normal_ = Eigen::Vector3f::UnitZ(), floor_color_;
  float floor_height_ = 0;  // position of the floor's plane along its normal [m]
  float least_ray_start_;   // [m]
};

}  // namespace weft::render
