#include "character/figure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "character/mannequin_shape.hpp"

namespace weft::character {
namespace {

// All places below are in cm, for a height of kTableHeight.

/// A colour (sRGB, 0 to 1) laid over what is there by a share.
struct Ink {
  Vec3 color = Vec3::Zero();
  double share = 0;

  void add(const Vec3& over, double by) {
    const double sum = by + share * (1 - by);
    if (sum > 0) color = (by * over + share * (1 - by) * color) / sum;
    share = sum;
  }
};

/// 1 where `depth` [cm] is inside, 0 outside, over a soft edge.
double inside(double depth, double edge) {
  const double t = std::clamp(0.5 + depth / edge, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Height of a line through points of ascending first coordinate, level beyond them.
double height(std::span<const Vec2> line, double at) {
  if (at <= line.front().x()) return line.front().y();
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (at > line[i].x()) continue;
    const double t = (at - line[i - 1].x()) / (line[i].x() - line[i - 1].x());
    return line[i - 1].y() + t * (line[i].y() - line[i - 1].y());
  }
  return line.back().y();
}

const Vec3 kHair(0.16, 0.115, 0.085), kShoe(0.13, 0.12, 0.125), kSole(0.07, 0.065, 0.065), kLip(0.36, 0.06, 0.07),
    kShade(0.24, 0.15, 0.12);

/// Hair and shoes, seen from the side; y from the front to the back.
Ink body_ink(double y, double z) {
  // From the forehead past the temple and the ear to the nape.
  static const Vec2 kHairline[] = {{-9.5, 170.3}, {-6.5, 168.2}, {-4.4, 165.0}, {-3.2, 162.0}, {-1.4, 159.4},
                                   {1, 157.6},    {3, 155.4},    {5, 153.6},    {7, 152.6}};
  // From the toes over the instep to the heel.
  static const Vec2 kShoeline[] = {{-11.5, 9.0}, {-9.2, 3.6}, {-4, 2.8}, {1, 3.8}, {5, 5.6}, {7, 6.2}};
  Ink ink;
  const double hair = inside(z - height(kHairline, y), 0.5);
  // Strands run back from the forehead.
  const double strands = std::sin(9 * z + 2 * y) * std::sin(2.3 * z - 0.7 * y + 1) * std::sin(23 * z + 4 * y + 2);
  ink.add(kHair * (1 + 0.35 * strands), hair);
  const double shoe = inside(height(kShoeline, y) - z, 0.15) * inside(10 - z, 0.2);
  ink.add(kShoe, shoe);
  ink.add(kSole, shoe * inside(0.9 - z, 0.15));
  return ink;
}

/// Brows, lids and lips, seen from the front; the same on both sides.
Ink face_ink(double x, double z) {
  Ink ink;
  const double side = std::abs(x), from_eye = side - 3.1;
  const auto ellipse = [](double across, double up, double wide, double high) {
    return 1 - std::hypot(across / wide, up / high);
  };
  // Sockets lie a little in the shade, the lid is a line that sinks to both sides.
  ink.add(kShade, 0.22 * inside(ellipse(from_eye, z - 164.1, 2.4, 1.5), 0.9));
  const double lid = 163.45 - 0.16 * from_eye * from_eye;
  ink.add(kShade * 0.6, 0.85 * inside(0.11 - std::abs(z - lid), 0.14) * inside(1.55 - std::abs(from_eye), 0.5));
  const double brow = 166.0 + 0.08 * from_eye - 0.09 * from_eye * from_eye;
  ink.add(kHair, 0.75 * inside(0.26 - std::abs(z - brow), 0.3) * inside(1.9 - std::abs(from_eye), 0.9));
  // Below the nose.
  ink.add(kShade, 0.3 * inside(ellipse(side - 0.75, z - 158.75, 0.75, 0.3), 0.7));
  // Lips, with the line between them.
  const double bow = 0.14 * std::cos(2.2 * side);
  ink.add(kLip, 0.4 * inside(ellipse(side, z - 156.2 - 0.3 * bow, 2.0, 0.8), 0.35));
  const double mouth = 156.25 + 0.5 * bow;
  ink.add(kShade * 0.7, 0.6 * inside(0.07 - std::abs(z - mouth), 0.12) * inside(1.85 - side, 0.5));
  return ink;
}

/// Between the fingers, seen from the side: they are `down` cm from the shoulder.
Ink hand_ink(double y, double down) {
  Ink ink;
  for (const double gap : {-1.75, 0.1, 1.9}) {
    const double first = 67.6 + 0.16 * (gap - 0.2) * (gap - 0.2);
    ink.add(kShade, 0.6 * inside(0.09 - std::abs(-y - 1.45 - gap * (1 - 0.02 * (down - first))), 0.16) *
                        inside(down - first, 1.2));
  }
  return ink;
}

using Painter = std::function<Ink(double, double)>;

/// A picture of what lies between `low` and `high` [cm].
Material painted(std::string name, const Vec2& low, const Vec2& high, int width, int height, const Painter& painter) {
  Material material;
  material.name = std::move(name);
  material.wrap_u = material.wrap_v = Material::Wrap::clamp;
  material.width = width;
  material.height = height;
  for (int row = height - 1; row >= 0; --row) {
    for (int column = 0; column < width; ++column) {
      const Vec2 share((column + 0.5) / width, (row + 0.5) / height);
      const Vec2 at = low + share.cwiseProduct(high - low);
      const Ink ink = painter(at.x(), at.y());
      for (int k = 0; k < 3; ++k)
        material.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(ink.color[k], 0.0, 1.0))));
      material.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(ink.share, 0.0, 1.0))));
    }
  }
  return material;
}

struct Sheet {
  Vec2 low, high;  // [cm]
};
const Sheet kBody{{-22, -1}, {14, 177}}, kFace{{-6, 153}, {6, 169}}, kHand{{-7, 62}, {6, 79}};

}  // namespace

Coloring figure_of(const mesh::Mesh& mesh, const MannequinBuild& build) {
  const double cm = build.height / kTableHeight;
  const auto joints = mannequin_joints(build);
  const Vec3& shoulder = joints[static_cast<std::size_t>(Joint::left_upper_arm)];
  const Vec3 along = (joints[static_cast<std::size_t>(Joint::left_hand)] - shoulder).normalized();
  enum : Index { body, face, hand };
  Coloring coloring;
  coloring.over_look = true;
  coloring.materials = {painted("body", kBody.low, kBody.high, 256, 1024, body_ink),
                        painted("face", kFace.low, kFace.high, 192, 256, face_ink),
                        painted("hands", kHand.low, kHand.high, 128, 128, hand_ink)};
  for (const auto& t : mesh.topology.triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[t[k]] / cm;
    const auto down = [&](const Vec3& p) { return (Vec3(std::abs(p.x()), p.y(), p.z()) - shoulder / cm).dot(along); };
    const auto on_face = [](const Vec3& p) {
      return p.y() < -5.5 && std::abs(p.x()) < 5.6 && p.z() > 153.5 && p.z() < 168.5;
    };
    const auto on_hand = [&](const Vec3& p) { return std::abs(p.x()) > 30 && down(p) > 63; };
    const Index which = std::ranges::all_of(corners, on_face)   ? face
                        : std::ranges::all_of(corners, on_hand) ? hand
                                                                : body;
    const Sheet& sheet = which == face ? kFace : which == hand ? kHand : kBody;
    std::array<Vec2, 3> places;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = corners[k];
      const Vec2 at = which == face ? Vec2(p.x(), p.z()) : which == hand ? Vec2(p.y(), down(p)) : Vec2(p.y(), p.z());
      places[k] = (at - sheet.low).cwiseQuotient(sheet.high - sheet.low);
    }
    coloring.material_of_triangle.push_back(which);
    coloring.uv.push_back(places);
  }
  return coloring;
}

}  // namespace weft::character
