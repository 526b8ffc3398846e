#include "film/character/figure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "film/character/mannequin_parts.hpp"
#include "film/character/mannequin_shape.hpp"
#include "film/character/pose.hpp"

namespace weft::character {
namespace {

// All positions in this file are in cm, for a body of the height kTableHeight.

/// A colour (sRGB, 0 to 1) and its opacity.
struct TranslucentColor {
  Vec3 color = Vec3::Zero();
  double opacity = 0;

  /// Paints the colour `over` with the opacity `by` on top.
  void add(const Vec3& over, double by) {
    const double sum = by + opacity * (1 - by);
    if (sum > 0) color = (by * over + opacity * (1 - by) * color) / sum;
    opacity = sum;
  }
};

/// Opacity of an area with a soft outline: 0 up to the depth -edge / 2, 1 from edge / 2 on, smooth between. `depth`:
/// distance of a point inside the outline; < 0: outside. `edge`: width of the soft outline, in the same unit.
double inside(double depth, double edge) {
  return ease(0.5 + depth / edge);
}

/// The y coordinate of a polyline at x = `at`. The x coordinates of its points must increase. Beyond its ends, y is
/// constant.
double height(std::span<const Vec2> line, double at) {
  if (at <= line.front().x()) return line.front().y();
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (at > line[i].x()) continue;
    const double t = (at - line[i - 1].x()) / (line[i].x() - line[i - 1].x());
    return line[i - 1].y() + t * (line[i].y() - line[i - 1].y());
  }
  return line.back().y();
}

const Vec3 kHairColor(0.20, 0.135, 0.095), kShoeColor(0.13, 0.12, 0.125), kSoleColor(0.07, 0.065, 0.065),
    kLipColor(0.62, 0.27, 0.25), kBlushColor(0.74, 0.40, 0.33), kShadowColor(0.30, 0.17, 0.13),
    kLashColor(0.10, 0.07, 0.055), kEyeWhiteColor(0.80, 0.77, 0.73), kIrisColor(0.27, 0.19, 0.13),
    kPupilColor(0.05, 0.04, 0.035);

/// Shoes, seen from the side; y grows from front to back.
TranslucentColor body_color_at(double y, double z) {
  // Upper edge of the shoe as (y, z), from the toes over the instep to the heel.
  static const Vec2 kShoeline[] = {{-11.5, 9.0}, {-9.2, 3.6}, {-4, 2.8}, {1, 3.8}, {5, 5.6}, {7, 6.2}};
  TranslucentColor pixel;
  const double shoe = inside(height(kShoeline, y) - z, 0.15) * inside(10 - z, 0.2);
  pixel.add(kShoeColor, shoe);
  pixel.add(kSoleColor, shoe * inside(0.9 - z, 0.15));
  return pixel;
}

/// Hair, seen from the side, with strands toward the knot and around it; and ears, slightly redder than the skin.
TranslucentColor head_color_at(double y, double z) {
  TranslucentColor pixel;
  pixel.add(kBlushColor, 0.18 * inside(1 - std::hypot((y - 1.4) / 2.6, (z - 162.4) / 3.6), 0.8));
  const double back = y - kKnot.x(), up = z - kKnot.y(), r = std::hypot(back, up), angle = std::atan2(up, back);
  // Strands fade toward the knot, because they would be finer than the pixels of the picture there.
  const double fine = 0.5 * std::sin(31 * angle + 1) * std::sin(13 * angle + 0.3 * r) +
                      0.5 * std::sin(71 * angle + 0.5 * r) * std::sin(9 * angle + 2);
  const double coiled = 0.8 * std::sin(3 * angle + 4.6 * r) * std::sin(2 * angle + 1.3 * r + 1);
  const double on_head = inside(r - kKnotRadius, 1.0);
  const double strands = on_head * std::min(1.0, r / 5) * fine + (1 - on_head) * coiled;
  pixel.add(kHairColor * (1 + 0.45 * strands), inside(-hairline_distance(y, z), 0.35));
  return pixel;
}

/// Brows, eyes, nostrils and lips, seen from the front; symmetric.
TranslucentColor face_color_at(double x, double z) {
  TranslucentColor pixel;
  const double side = std::abs(x), from_eye = side - 3.05;
  const auto ellipse = [](double across, double up, double wide, double high) {
    return 1 - std::hypot(across / wide, up / high);
  };
  // Cheeks, and the shade of the eye sockets.
  pixel.add(kBlushColor, 0.14 * inside(ellipse(side - 3.7, z - 160.6, 2.0, 1.7), 1.2));
  pixel.add(kShadowColor, 0.16 * inside(ellipse(from_eye, z - 164.3, 2.3, 1.2), 1.0));
  // Almond-shaped opening between the lids with the eye in it, and lashes along the upper lid.
  const double t = from_eye / 1.35, arc = std::max(1 - t * t, 0.0);
  const double low = 163.62 - 0.30 * arc + 0.05 * t, high = 163.62 + 0.42 * arc + 0.05 * t;
  const double open = inside(std::min(z - low, high - z), 0.10) * inside(1.3 - std::abs(from_eye), 0.2);
  const double from_iris = std::hypot(from_eye, z - 163.70);
  pixel.add(kEyeWhiteColor, open);
  pixel.add(kIrisColor, open * inside(0.46 - from_iris, 0.10));
  pixel.add(kPupilColor, open * inside(0.20 - from_iris, 0.10));
  pixel.add(kLashColor, 0.45 * open * inside(z - high + 0.16, 0.2));
  pixel.add(kLashColor, 0.9 * inside(0.075 - std::abs(z - high), 0.10) * inside(1.45 - std::abs(from_eye), 0.3));
  pixel.add(kShadowColor, 0.45 * inside(0.05 - std::abs(z - low), 0.12) * inside(1.3 - std::abs(from_eye), 0.5));
  const double brow = 165.85 + 0.10 * from_eye - 0.10 * from_eye * from_eye;
  const double thick = 0.27 - 0.06 * from_eye;
  pixel.add(kHairColor, 0.62 * inside(thick - std::abs(z - brow), 0.3) * inside(1.9 - std::abs(from_eye), 0.9));
  pixel.add(kShadowColor * 0.5, 0.8 * inside(ellipse(side - 0.58, z - 159.35, 0.36, 0.22), 0.6));
  // Lips with a dark line between them. The upper edge of the upper lip is curved ("bow").
  const double bow = 0.16 * std::cos(2.2 * side), end = inside(2.35 - side, 0.5);
  const double wide = std::max(1 - side * side / (2.45 * 2.45), 0.0);
  const double mouth = 157.2 + 0.25 * bow;
  const double top = mouth + (0.62 + 0.8 * bow) * std::sqrt(wide), bottom = mouth - 0.95 * wide;
  pixel.add(kLipColor, 0.62 * end * inside(std::min(z - bottom, top - z), 0.22));
  pixel.add(kShadowColor * 0.7, 0.65 * inside(0.06 - std::abs(z - mouth), 0.12) * inside(2.2 - side, 0.5));
  return pixel;
}

using Painter = std::function<TranslucentColor(double, double)>;

/// Paints a picture of the area between `low` and `high` [cm].
Material paint(std::string name, const Vec2& low, const Vec2& high, int width, int height, const Painter& painter) {
  Material material;
  material.name = std::move(name);
  material.wrap_u = material.wrap_v = Material::Wrap::clamp;
  material.width = width;
  material.height = height;
  for (int row = height - 1; row >= 0; --row) {
    for (int column = 0; column < width; ++column) {
      const Vec2 fraction((column + 0.5) / width, (row + 0.5) / height);
      const Vec2 at = low + fraction.cwiseProduct(high - low);
      const TranslucentColor pixel = painter(at.x(), at.y());
      for (int k = 0; k < 3; ++k)
        material.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(pixel.color[k], 0.0, 1.0))));
      material.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(pixel.opacity, 0.0, 1.0))));
    }
  }
  return material;
}

struct PictureArea {
  Vec2 low, high;  // [cm]
};
const PictureArea kBody{{-22, -1}, {14, 177}}, kFace{{-6, 153}, {6, 169}}, kHead{{-15, 150}, {15, 177}};

/// A triangle uses the picture of the head only if all its corners are above this height [cm].
constexpr double kHeadFrom = 152;

}  // namespace

Coloring paint_figure(const mesh::Mesh& mesh, const MannequinBuild& build) {
  const double cm = build.height / kTableHeight;
  enum : Index { body, face, head };
  Coloring coloring;
  coloring.covers_look = true;
  coloring.materials = {paint("body", kBody.low, kBody.high, 192, 896, body_color_at),
                        paint("face", kFace.low, kFace.high, 288, 384, face_color_at),
                        paint("head", kHead.low, kHead.high, 512, 512, head_color_at)};
  for (const auto& t : mesh.topology.triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[t[k]] / cm;
    const auto on_face = [](const Vec3& p) {
      return p.y() < -5.0 && std::abs(p.x()) < 5.8 && p.z() > 153.5 && p.z() < 168.8 &&
             hairline_distance(p.y(), p.z()) > 0.6;
    };
    const auto on_head = [](const Vec3& p) { return p.z() > kHeadFrom && std::abs(p.x()) < 12; };
    const Index which = std::ranges::all_of(corners, on_face)   ? face
                        : std::ranges::all_of(corners, on_head) ? head
                                                                : body;
    const PictureArea& sheet = which == face ? kFace : which == head ? kHead : kBody;
    std::array<Vec2, 3> places;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = corners[k];
      const Vec2 at = which == face ? Vec2(p.x(), p.z()) : Vec2(p.y(), p.z());
      places[k] = (at - sheet.low).cwiseQuotient(sheet.high - sheet.low);
    }
    coloring.material_of_triangle.push_back(which);
    coloring.uv.push_back(places);
  }
  return coloring;
}

}  // namespace weft::character
