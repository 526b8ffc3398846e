#include "tools/compare/flip.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "film/image/color.hpp"

namespace weft::compare {
namespace flip {
namespace {

using Matrix = Eigen::Matrix3f;

// Columns: XYZ of the primaries of IEC 61966-2-1, scaled so that their sum is the white point D65.
Matrix xyz_from_linear() {
  const auto xyz = [](double x, double y) { return Vec3(x / y, 1, (1 - x - y) / y); };
  Mat3 primaries;
  primaries << xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06);
  const Vec3 weights = primaries.inverse() * xyz(0.3127, 0.3290);
  return (primaries * weights.asDiagonal()).cast<float>();
}

// Linear sRGB to XYZ relative to white, which is (1, 1, 1).
const Matrix& relative_xyz() {
  static const Matrix matrix = [] {
    const Matrix xyz = xyz_from_linear();
    const Color white = xyz * Color::Ones();
    return Matrix(white.cwiseInverse().asDiagonal() * xyz);
  }();
  return matrix;
}

const Matrix& linear_from_relative_xyz() {
  static const Matrix matrix = relative_xyz().inverse();
  return matrix;
}

// Curve of L*a*b* (CIE 15:2004): cube root, and a straight line below (6/29)³.
float lab_curve(float t) {
  constexpr float kEdge = 6.0f / 29;
  return t > kEdge * kEdge * kEdge ? std::cbrt(t) : t / (3 * kEdge * kEdge) + 4.0f / 29;
}

// Contrast sensitivity function a1 exp(-b1 f²) + a2 exp(-b2 f²), f in cycles per degree. Its inverse Fourier transform
// in one dimension is the kernel a1 sqrt(pi/b1) exp(-pi² x²/b1) + a2 sqrt(pi/b2) exp(-pi² x²/b2), x in degrees. Like
// the paper, filter_by_contrast_sensitivity() uses this kernel in two dimensions, with x as the distance from the
// centre.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array kSensitivities{Sensitivity{1, 0.0047, 0, 1e-5}, Sensitivity{1, 0.0053, 0, 1e-5},
                                    Sensitivity{34.1, 0.04, 13.5, 0.025}};

// Samples exp(-pi² x² / b) at whole pixels; x is their distance in degrees. The radius is the paper's: three times the
// standard deviation of the widest kernel.
std::vector<float> gaussian(double b) {
  constexpr double kPiSq = std::numbers::pi * std::numbers::pi;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPiSq)) * kPixelsPerDegree));
  std::vector<float> values;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / kPixelsPerDegree;
    values.push_back(static_cast<float>(std::exp(-kPiSq * x * x / b)));
  }
  return values;
}

double sum_of(std::span<const float> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

struct FeatureKernels {
  std::vector<float> smooth, edge, point;
};

// A Gaussian and its first two derivatives. As in the paper, the kernels are scaled so that in two
// dimensions (a derivative in one direction, the Gaussian in the other) the positive weights sum to
// 1 and the negative weights to -1.
FeatureKernels make_feature_kernels() {
  constexpr double kWidth = 0.082;  // [degrees], of the eye's edge detector (Section 4.2.1)
  const double sigma = 0.5 * kWidth * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  FeatureKernels kernels;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-i * i / (2 * sigma * sigma));
    kernels.smooth.push_back(static_cast<float>(g));
    kernels.edge.push_back(static_cast<float>(-i * g));
    kernels.point.push_back(static_cast<float>((i * i / (sigma * sigma) - 1) * g));
  }
  const auto scale = [](std::vector<float>& kernel) {
    double positive = 0, negative = 0;
    for (const float v : kernel) (v > 0 ? positive : negative) += std::abs(v);
    for (float& v : kernel) v = static_cast<float>(v / (v > 0 ? positive : negative));
  };
  scale(kernels.smooth);
  scale(kernels.edge);
  scale(kernels.point);
  return kernels;
}

// Length of (d/dx, d/dy) at each pixel.
Plane<float> magnitude(const Plane<float>& y, std::span<const float> derivative, std::span<const float> smooth) {
  Plane<float> dx = convolve<float>(y, derivative, smooth);
  const Plane<float> dy = convolve<float>(y, smooth, derivative);
  for (std::size_t i = 0; i < dx.values.size(); ++i) dx.values[i] = std::hypot(dx.values[i], dy.values[i]);
  return dx;
}

Channels opponent_channels(const image::Image& image) {
  std::array<float, 256> linear;
  for (int level = 0; level < 256; ++level) linear[level] = static_cast<float>(image::linear_from_srgb(level / 255.0));
  Channels channels;
  for (Plane<float>& plane : channels) plane = Plane<float>(image.width, image.height);
  for_each_row(image.height, [&](int y) {
    const std::uint8_t* from = image.pixel(0, y);
    for (int x = 0; x < image.width; ++x, from += 3) {
      const Color opponent = opponent_from_linear({linear[from[0]], linear[from[1]], linear[from[2]]});
      for (int c = 0; c < 3; ++c) channels[c].row(y)[x] = opponent[c];
    }
  });
  return channels;
}

// Filters the channels, clamps the colours to those that a display shows, and converts them with hunt_lab().
Channels seen_colors(const Channels& opponent) {
  Channels seen;
  for (int c = 0; c < 3; ++c) seen[c] = filter_by_contrast_sensitivity(opponent[c], c);
  for_each_row(seen[0].height, [&](int y) {
    for (int x = 0; x < seen[0].width; ++x) {
      const Color linear = linear_from_opponent({seen[0].row(y)[x], seen[1].row(y)[x], seen[2].row(y)[x]});
      const Color lab = hunt_lab(linear.cwiseMax(0).cwiseMin(1));
      for (int c = 0; c < 3; ++c) seen[c].row(y)[x] = lab[c];
    }
  });
  return seen;
}

// Scales Y of Y C_x C_z from [-16, 100] to [0, 1].
Plane<float> unit_range(Plane<float> y) {
  for (float& value : y.values) value = (value + 16) / 116;
  return y;
}

}  // namespace

Color opponent_from_linear(const Color& linear) {
  const Color xyz = relative_xyz() * linear;
  return {116 * xyz.y() - 16, 500 * (xyz.x() - xyz.y()), 200 * (xyz.y() - xyz.z())};
}

Color linear_from_opponent(const Color& opponent) {
  const float y = (opponent[0] + 16) / 116;
  return linear_from_relative_xyz() * Color(y + opponent[1] / 500, y, y - opponent[2] / 200);
}

Color hunt_lab(const Color& linear) {
  const Color curve = (relative_xyz() * linear).unaryExpr(&lab_curve);
  const float lightness = 116 * curve.y() - 16;
  return {lightness, 0.01f * lightness * 500 * (curve.x() - curve.y()),
          0.01f * lightness * 200 * (curve.y() - curve.z())};
}

float hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

float remap_distance(float distance) {
  constexpr float kPower = 0.7f, kBend = 0.4f, kAtBend = 0.95f;
  static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kPower);
  const float fraction = std::pow(distance, kPower) / largest;
  const float value =
      fraction < kBend ? kAtBend * fraction / kBend : kAtBend + (1 - kAtBend) * (fraction - kBend) / (1 - kBend);
  return std::min(value, 1.0f);
}

Plane<float> filter_by_contrast_sensitivity(const Plane<float>& plane, int channel) {
  const Sensitivity& s = kSensitivities[channel];
  const auto weighted = [&](double a, double b, double& total) {
    std::vector<float> kernel = gaussian(b);
    const double weight = a * std::sqrt(std::numbers::pi / b), sum = sum_of(kernel);
    total += weight * sum * sum;
    Plane<float> part = convolve<float>(plane, kernel, kernel);
    for (float& value : part.values) value *= static_cast<float>(weight);
    return part;
  };
  double total = 0;
  Plane<float> seen = weighted(s.a1, s.b1, total);
  if (s.a2 > 0) {
    const Plane<float> second = weighted(s.a2, s.b2, total);
    for (std::size_t i = 0; i < seen.values.size(); ++i) seen.values[i] += second.values[i];
  }
  for (float& value : seen.values) value /= static_cast<float>(total);
  return seen;
}

Plane<float> feature_difference(const Plane<float>& reference, const Plane<float>& test) {
  static const FeatureKernels kernels = make_feature_kernels();
  const auto stronger = [&](std::span<const float> derivative) {
    Plane<float> a = magnitude(reference, derivative, kernels.smooth);
    const Plane<float> b = magnitude(test, derivative, kernels.smooth);
    for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] = std::abs(a.values[i] - b.values[i]);
    return a;
  };
  Plane<float> edges = stronger(kernels.edge);
  const Plane<float> points = stronger(kernels.point);
  for (std::size_t i = 0; i < edges.values.size(); ++i) {
    // The power 1/2 is the paper's. The factor 1/√2 limits a corner, which is an edge in both directions, to 1.
    edges.values[i] = std::sqrt(std::max(edges.values[i], points.values[i]) / std::numbers::sqrt2_v<float>);
  }
  return edges;
}

}  // namespace flip

Plane<float> flip_map(const image::Image& reference, const image::Image& test) {
  const flip::Channels opponent_a = flip::opponent_channels(reference), opponent_b = flip::opponent_channels(test);
  const flip::Channels a = flip::seen_colors(opponent_a), b = flip::seen_colors(opponent_b);
  Plane<float> map = flip::feature_difference(flip::unit_range(opponent_a[0]), flip::unit_range(opponent_b[0]));
  for_each_row(map.height, [&](int y) {
    float* to = map.row(y);
    for (int x = 0; x < map.width; ++x) {
      const flip::Color lab_a(a[0].row(y)[x], a[1].row(y)[x], a[2].row(y)[x]);
      const flip::Color lab_b(b[0].row(y)[x], b[1].row(y)[x], b[2].row(y)[x]);
      // A colour difference has more weight where features differ too (Section 4.3).
      to[x] = std::pow(flip::remap_distance(flip::hyab(lab_a, lab_b)), 1 - std::min(to[x], 1.0f));
    }
  });
  return map;
}

}  // namespace weft::compare
