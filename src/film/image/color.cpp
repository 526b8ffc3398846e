#include "film/image/color.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::image {
namespace {

/// Converts CIE L*a*b* (D65, CIE 15:2004) to linear sRGB (IEC 61966-2-1).
Vec3 linear_from_lab(double lightness, double a, double b) {
  const auto inverse = [](double t) { return t > 6.0 / 29 ? t * t * t : 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29); };
  const double fy = (lightness + 16) / 116;
  const Vec3 xyz(0.95047 * inverse(fy + a / 500), inverse(fy), 1.08883 * inverse(fy - b / 200));
  Mat3 rgb_from_xyz;
  rgb_from_xyz << 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252;
  return rgb_from_xyz * xyz;
}

bool in_gamut(const Vec3& rgb) {
  return rgb.minCoeff() >= 0 && rgb.maxCoeff() <= 1;
}

}  // namespace

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Vec3 linear_from_srgb(const Vec3& encoded) {
  return encoded.unaryExpr([](double c) { return linear_from_srgb(c); });
}

Vec3 srgb_from_linear(const Vec3& linear) {
  return linear.unaryExpr([](double c) { return srgb_from_linear(c); });
}

Vec3 heat_color(double t) {
  t = std::clamp(t, 0.0, 1.0);
  // A helix in L*a*b*: lightness is linear in t, and hue runs from violet blue (290 degrees) through red (360) to
  // yellow (100 + 360).
  const double lightness = 15 + 75 * t;
  const double hue = (290 + 170 * t) * std::numbers::pi / 180;
  // Finds the largest chroma inside the gamut at this lightness and hue by 20 bisections.
  double low = 0, high = 90;
  for (int i = 0; i < 20; ++i) {
    const double chroma = 0.5 * (low + high);
    (in_gamut(linear_from_lab(lightness, chroma * std::cos(hue), chroma * std::sin(hue))) ? low : high) = chroma;
  }
  return linear_from_lab(lightness, low * std::cos(hue), low * std::sin(hue)).cwiseMax(0).cwiseMin(1);
}

std::array<Vec3, kHeatColors> heat_table() {
  std::array<Vec3, kHeatColors> table;
  for (int i = 0; i < kHeatColors; ++i) table[i] = heat_color(i / double(kHeatColors - 1));
  return table;
}

}  // namespace weft::image
