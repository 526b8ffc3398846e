#include "film/render/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

using Look = frame::Stage::Look;

Vec3 linear(double r, double g, double b) {
  return image::linear_from_srgb(Vec3(r, g, b));
}

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Basis functions of Irradiance.
std::array<double, 9> quadric(const Vec3& n) {
  const double x = n.x(), y = n.y(), z = n.z();
  return {1, x, y, z, x * y, y * z, z * x, z * z, x * x - y * y};
}

Style make_style(Look look) {
  Style style;
  switch (look) {
    case Look::studio:
      style.sky_color = linear(0.96, 0.975, 1.0);
      style.sky_intensity = 0.44;
      style.horizon = Vec3::Constant(0.74);
      style.zenith = Vec3::Constant(0.34);
      style.glow = 0.35;
      break;
    case Look::stage:
      style.sky_color = linear(0.62, 0.66, 0.78);
      style.sky_intensity = 0.34;
      style.horizon = linear(0.26, 0.265, 0.30);
      style.zenith = linear(0.09, 0.09, 0.115);
      style.glow = 0.9;
      style.floor_tint = 0.2;
      style.floor_roughness = 0.25;
      style.toe = 0.006;
      style.exposes = false;
      break;
    case Look::daylight:
      style.sky_color = linear(0.80, 0.90, 1.0);
      style.sky_intensity = 0.36;
      style.horizon = linear(0.86, 0.92, 0.98);
      style.zenith = linear(0.32, 0.55, 0.88);
      style.toe = 0.01;
      break;
    case Look::clay:
    case Look::wire:
    case Look::strain:
      style.sky_color = linear(0.97, 0.98, 1.0);
      style.sky_intensity = 0.5;
      style.horizon = Vec3::Constant(0.62);
      style.zenith = Vec3::Constant(0.42);
      style.plain = look != Look::strain;
      style.edges = look == Look::wire;
      break;
  }
  return style;
}

}  // namespace

Style style_of(const frame::Stage& stage) {
  Style style = make_style(stage.look);
  if (stage.sky_color) style.sky_color = image::linear_from_srgb(*stage.sky_color);
  style.sky_intensity = std::clamp(stage.sky_intensity.value_or(style.sky_intensity), 0.0, 1.0);
  return style;
}

Vec3 Surroundings::light(const Vec3& toward, double alpha) const {
  const double height = toward.dot(up), blur = 0.08 + alpha;
  const Vec3 above = horizon + smoothstep(0, 1, height) * (sky - horizon);
  Vec3 sum = ground + smoothstep(-blur, blur, height) * (above - ground);
  // The convolution of two spherical Gaussians is nearly one with the sharpness a b / (a + b) (Wang et al.,
  // "All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance", 2009).
  const double own = 2 / (alpha * alpha + 1e-4);
  for (const Box& box : boxes) {
    const double sharpness = box.sharpness * own / (box.sharpness + own);
    sum += sharpness / box.sharpness * std::exp(sharpness * (box.axis.dot(toward) - 1)) * box.light;
  }
  return sum;
}

Surroundings make_surroundings(const Style& style, const frame::Stage& stage, const Vec3& up,
                               std::span<const frame::Light> lights, const Vec3& ground) {
  // `key`: horizontal direction to the first light. The boxes are placed relative to this direction, not to the camera,
  // so that they do not move with the camera.
  Vec3 key = Vec3::Zero();
  if (!lights.empty()) {
    const frame::Light& first = lights.front();
    key = first.kind == frame::Light::Kind::spot ? Vec3(first.position - first.target) : Vec3(-first.direction);
  }
  key -= key.dot(up) * up;
  key = key.norm() > 1e-6 ? Vec3(key.normalized()) : Vec3(up.unitOrthogonal());
  const Vec3 side = up.cross(key);
  const auto box = [&](double toward_key, double sideways, double height, double sharpness, double light) {
    return Surroundings::Box{(toward_key * key + sideways * side + height * up).normalized(), sharpness,
                             Vec3::Constant(light)};
  };

  Surroundings around;
  around.up = up;
  switch (stage.look) {
    case Look::stage:
      around.sky = Vec3::Constant(0.2);
      around.horizon = Vec3::Constant(0.1);
      // Rim lights: narrow boxes opposite the first light and at the side; also a box overhead.
      around.boxes = {box(-0.9, 0.6, 0.5, 14, 3), box(-0.3, -1, 0.5, 14, 2.2), box(0.3, 0.2, 1, 10, 1.5)};
      break;
    case Look::daylight:
      around.sky = Vec3(0.55, 0.8, 1.1);
      around.horizon = Vec3(1.0, 1.0, 1.0);
      around.boxes = {box(1, 0, 0.9, 6, 0.7), box(-1, 0, 0.4, 3, 0), box(0, 1, 0.4, 3, 0)};
      break;
    default:
      around.sky = Vec3::Constant(0.4);
      around.horizon = Vec3::Constant(0.3);
      // A large box overhead, a fill light at the side, and a narrow box opposite the first light.
      around.boxes = {box(0.2, 0.1, 1, 5, 1.2), box(-0.4, -1, 0.5, 4, 1.1), box(-1, 0.8, 0.45, 14, 2.0)};
      break;
  }
  // Scales sky and boxes so that a horizontal surface receives from them Style::sky_intensity (as a
  // fraction of all light) times Style::sky_color. For `daylight` without Stage::sky_color, all channels have the same
  // factor, which keeps the blue of the sky.
  const Vec3 flat = evaluate_irradiance(irradiance_of(around), up);
  const Vec3 scale = style.sky_intensity * style.sky_color.cwiseQuotient(flat.cwiseMax(1e-6));
  const bool tinted = stage.look == Look::daylight;
  const Vec3 even = Vec3::Constant(style.sky_intensity / flat.dot(kLuminance));
  const Vec3 gain = tinted && !stage.sky_color ? even : scale;
  for (Vec3* light : {&around.sky, &around.horizon}) *light = light->cwiseProduct(gain);
  for (Surroundings::Box& each : around.boxes) each.light = each.light.cwiseProduct(gain);
  around.ground = ground;
  return around;
}

Irradiance irradiance_of(const Surroundings& surroundings) {
  // Sums over 24 x 48 cells of the sphere with equal areas; these are enough, because the integrand is smooth.
  constexpr int kRows = 24, kColumns = 48;
  constexpr double kPi = std::numbers::pi;
  // Squared normalisation factors of the harmonics, times the factors of the clamped cosine (pi, 2 pi / 3 and pi / 4),
  // divided by pi to get the light that matte white shows.
  constexpr double kZero = 1 / (4 * kPi), kOne = 3 / (4 * kPi) * 2 / 3, kCross = 15 / (4 * kPi) / 4,
                   kUp = 5 / (16 * kPi) / 4, kSaddle = 15 / (16 * kPi) / 4;
  std::array<Vec3, 9> sums;
  sums.fill(Vec3::Zero());
  for (int row = 0; row < kRows; ++row) {
    const double z = -1 + (row + 0.5) * 2 / kRows, r = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double angle = (column + 0.5) * 2 * kPi / kColumns;
      const Vec3 toward(r * std::cos(angle), r * std::sin(angle), z);
      const Vec3 light = surroundings.light(toward, 0.1) * (4 * kPi / (kRows * kColumns));
      const std::array<double, 9> basis = quadric(toward);
      for (int k = 0; k < 9; ++k) sums[k] += (k == 7 ? 3 * basis[7] - 1 : basis[k]) * light;
    }
  }
  Irradiance result;
  result[0] = kZero * sums[0] - kUp * sums[7];
  for (int k = 1; k < 4; ++k) result[k] = kOne * sums[k];
  for (int k = 4; k < 7; ++k) result[k] = kCross * sums[k];
  result[7] = 3 * kUp * sums[7];
  result[8] = kSaddle * sums[8];
  return result;
}

Vec3 evaluate_irradiance(const Irradiance& irradiance, const Vec3& n) {
  const std::array<double, 9> basis = quadric(n);
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 9; ++k) sum += basis[k] * irradiance[k];
  return sum;
}

}  // namespace weft::render
