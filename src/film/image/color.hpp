// Conversion between sRGB, in which scenes give colours, and linear RGB, in which light is added.
#pragma once

#include <array>

#include "core/types.hpp"

namespace weft::image {

/// Conversion of each channel between encoded sRGB and linear light, both from 0 to 1 (IEC 61966-2-1).
double linear_from_srgb(double encoded);
double srgb_from_linear(double linear);
Vec3 linear_from_srgb(const Vec3& encoded);
Vec3 srgb_from_linear(const Vec3& linear);

/// Number of entries of heat_table().
inline constexpr int kHeatColors = 256;

/// Linear RGB of the colour scale for strain or speed, at t clamped to [0,1]: from dark blue through magenta and orange
/// to pale yellow. Lightness (CIE L*) rises linearly from 15 to 90, so that equal differences look equal, also in grey.
Vec3 heat_color(double t);

/// Entry i is heat_color(i / (kHeatColors - 1)).
std::array<Vec3, kHeatColors> heat_table();

}  // namespace weft::image
