// Environment light and backdrop of each look.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/transforms.hpp"

namespace weft::render {

inline const Vec3 kLuminance(0.2126, 0.7152, 0.0722);  ///< luminance weights of Rec. 709

/// Settings of a look besides its lights. Colours are linear.
struct Style {
  Vec3 sky_color = Vec3::Ones();  ///< colour of the environment light on a horizontal surface
  double sky_intensity = 0.45;    ///< fraction of all light that the environment provides
  Vec3 horizon = Vec3::Ones();    ///< backdrop at the horizon; if grey: factor on Exposure::floor (unshaded floor)
  Vec3 zenith = Vec3::Ones();     ///< backdrop straight above; if `horizon` is grey: factor on Exposure::floor
  double glow = 0;                ///< fraction by which the backdrop is darker far from the subjects than behind them
  double floor_tint = 1;          ///< factor on the colour of the floor
  double floor_roughness = 1;     ///< upper limit on the roughness of a floor, unless the floor is fully matte (1)
  double toe = 0;                 ///< linear light below which tones are darkened, as on film; 0: none
  /// Whether expose() increases the direct light, within limits, until unshaded floor is as bright as its own colour.
  bool exposes = true;
  bool plain = false;  ///< draws all surfaces as clay, without their own colours
  bool edges = false;  ///< draws the edges of faces
};
/// The style of the look, with the sky colour and intensity of `stage` if these are set.
Style style_of(const frame::Stage& stage);

/// Environment light for each direction: a sky, a ground, and soft boxes as spherical Gaussians. Unit: under uniform
/// light of value 1, a matte white surface has the linear colour 1.
struct Surroundings {
  struct Box {
    Vec3 axis = Vec3::UnitZ();
    double sharpness = 1;  ///< the light falls to 1/e if the cosine to the axis is 1 - 1/sharpness
    Vec3 light = Vec3::Zero();
  };
  static constexpr int kBoxes = 3;
  /// `sky`, `horizon`, `ground`: light from straight above, from just above the horizon, and from below.
  Vec3 up = Vec3::UnitZ(), sky = Vec3::Zero(), horizon = Vec3::Zero(), ground = Vec3::Zero();
  std::array<Box, kBoxes> boxes;

  /// Light from direction `toward` (unit), blurred as by a reflection with roughness squared
  /// `alpha`. surroundings() in shaders/surroundings.glsl has the same formula for reflections, with
  /// half of `ground`, because the floor near glossy surfaces is often shaded (pack_frame()).
  Vec3 light(const Vec3& toward, double alpha) const;
};

/// The surroundings of a style, scaled so that an unoccluded horizontal surface receives the
/// style's fraction of all light. The boxes are placed relative to the first light. `ground`: light
/// from below.
Surroundings make_surroundings(const Style& style, const frame::Stage& stage, const Vec3& up,
                               std::span<const frame::Light> lights, const Vec3& ground);

/// Light that a matte white surface with normal n shows (irradiance / pi): a quadratic polynomial in n. Coefficients of
/// 1, x, y, z, xy, yz, zx, z², x² - y²: the first nine spherical harmonics, convolved with the clamped cosine
/// (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
using Irradiance = std::array<Vec3, 9>;
Irradiance irradiance_of(const Surroundings& surroundings);
Vec3 evaluate_irradiance(const Irradiance& irradiance, const Vec3& n);

}  // namespace weft::render
