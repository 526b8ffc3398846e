// Colour spaces: scenes use sRGB, light is added in linear RGB.
#pragma once

#include <array>

#include "core/types.hpp"

namespace weft::image {

/// IEC 61966-2-1: encoded sRGB [0,1] to linear light and back, per channel.
double linear_from_srgb(double encoded);
double srgb_from_linear(double linear);
Vec3 linear_from_srgb(const Vec3& encoded);
Vec3 srgb_from_linear(const Vec3& linear);

/// Number of entries of the heat colour table.
inline constexpr int kHeatColors = 256;

/// Linear RGB at position t of the heat scale, clamped to [0,1]: dark blue through magenta and orange to pale yellow.
/// Lightness (CIE L*) rises linearly from 15 to 90, so that equal differences look equal, also in grey.
Vec3 heat_color(double t);

/// heat_color at i / (kHeatColors - 1).
std::array<Vec3, kHeatColors> heat_table();

}  // namespace weft::image
