// What stands around the subjects and lights them from all sides, as the word of a scene's look has it.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "frame/frame_snapshot.hpp"
#include "render/transforms.hpp"

namespace weft::render {

/// What a look decides beside the light. Colours are linear.
struct Style {
  Vec3 sky_color = Vec3::Ones();  ///< of the light from around, where it meets what lies flat
  double sky_intensity = 0.45;    ///< its share of all light
  Vec3 horizon = Vec3::Ones();    ///< backdrop at the horizon, times what the floor shows in full light
  Vec3 zenith = Vec3::Ones();     ///< and straight above
  double glow = 0;                ///< share by which the backdrop is brighter behind the subjects than far from them
  double floor_tint = 1;          ///< factor on the color of the floor
  double floor_roughness = 1;     ///< of the floor, where its own is not below
  double toe = 0;                 ///< linear light below which tones are deepened, as film does; 0: colors as given
  bool exposes = true;            ///< direct light is turned up until floor shows its own color
  bool plain = false;             ///< all surfaces of clay, none of their own colors
  bool edges = false;             ///< edges of faces are drawn
};
Style style_of(const frame::Stage& stage);

/// Light from each direction, in units in which a matte white surface under that of all directions shows it: a sky, a
/// ground, and soft boxes as spherical Gaussians.
struct Surroundings {
  struct Box {
    Vec3 axis = Vec3::UnitZ();
    double sharpness = 1;  ///< falls to 1/e where the cosine to the axis is 1/sharpness less
    Vec3 light = Vec3::Zero();
  };
  static constexpr int kBoxes = 3;
  Vec3 up = Vec3::UnitZ(), sky = Vec3::Zero(), horizon = Vec3::Zero(), ground = Vec3::Zero();
  std::array<Box, kBoxes> boxes;

  /// From around `toward` (unit), blurred as the reflection of a surface of roughness² `alpha`; as surroundings() of
  /// shaders/surroundings.glsl.
  Vec3 light(const Vec3& toward, double alpha) const;
};

/// Of a style, scaled such that what lies flat and open gets the style's share of all light. The boxes stand about the
/// first light as a photographer's do. `ground` is the light that comes from below.
Surroundings surround(const Style& style, const frame::Stage& stage, const Vec3& up,
                      std::span<const frame::Light> lights, const Vec3& ground);

/// Light that matte white facing n takes: a quadric in n, whose coefficients of 1, x, y, z, xy, yz, zx, z², x² - y² are
/// the first nine harmonics times what a cosine keeps of them (Ramamoorthi and Hanrahan, "An Efficient Representation
/// for Irradiance Environment Maps", 2001).
using Irradiance = std::array<Vec3, 9>;
Irradiance irradiance_of(const Surroundings& surroundings);
Vec3 at(const Irradiance& irradiance, const Vec3& n);

}  // namespace weft::render
