// Head and hair of the mannequin. Lengths are in centimetres and estimated. The eyes are at half the height of the
// head.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/character/mannequin_parts.hpp"
#include "film/character/mannequin_shape.hpp"

namespace weft::character {
namespace {

/// Hairline from the forehead along the temple and around the ear to the nape, as (backward, up) [cm].
const Vec2 kHairline[] = {{-13, 171.4},  {-9, 170.6},   {-7.8, 169.6}, {-6.8, 168.2}, {-5.9, 166.6}, {-5.0, 165.2},
                          {-4.0, 164.1}, {-3.0, 163.3}, {-2.1, 162.9}, {-1.3, 163.2}, {-0.7, 164.2}, {0.0, 165.4},
                          {1.0, 166.3},  {2.2, 166.6},  {3.5, 166.2},  {4.5, 165.1},  {5.1, 163.4},  {5.4, 160.8},
                          {5.8, 158.4},  {6.8, 156.9},  {8.5, 156.4},  {13, 156.4}};

/// Skull and jaw, without features.
void add_skull(BlendedBody& body, const Scale& s) {
  const double jaw = s.blend(1, 1.08);
  body.add(ellipsoid(s, {0, -0.3, 166.0}, {7.1, 9.0, 8.9}), 3 * s.length, false);
  const Rows face{{154.9, 0, 4.6, 3.0 * jaw, 3.7, 4.0, 2.2}, {156.8, 0, 3.4, 4.7 * jaw, 5.0, 5.0, 2.2},
                  {159, 0, 2.3, 5.75 * jaw, 6.3, 5.0, 2.2},  {162, 0, 1.6, 6.35, 7.3, 5.0, 2.2},
                  {165, 0, 1.2, 6.5, 7.7, 5.0, 2.2},         {168, 0, 0.7, 6.3, 7.7, 5.0, 2.1}};
  body.add(Loft({}, scale_sections(face, s, false), 1.7 * s.length, 4.5 * s.length), 3 * s.length, false);
}

void add_eyes(BlendedBody& body, const Scale& s) {
  // Eye sockets below the brows, cheekbones, and eyeballs.
  body.carve(ellipsoid(s, {3.0, 9.75, 163.95}, {2.0, 1.95, 1.25}, 0, 14), 1.4 * s.length, true);
  body.add(ellipsoid(s, {3.9, 5.6, 161.2}, {2.3, 2.0, 1.6}, 0, 25), 3 * s.length, true);
  body.add(ellipsoid(s, {3.05, 7.2, 163.95}, {1.35, 1.2, 1.2}), 0.4 * s.length, true);
  // Upper lids.
  body.add(ellipsoid(s, {3.05, 7.3, 164.45}, {1.65, 1.3, 0.75}, 14, 10), 0.3 * s.length, true);
}

void add_nose(BlendedBody& body, const Scale& s) {
  LoftFrame ridge;
  ridge.origin = s.length * Vec3(0, -8.25, 165.4);
  const double slope = 0.42;
  ridge.along = Vec3(0, -std::sin(slope), -std::cos(slope));
  ridge.v = Vec3(0, -std::cos(slope), std::sin(slope));
  const Rows rows{{0, 0, -0.15, 0.9, 0.6, 1.5, 2},
                  {1.6, 0, -0.3, 0.8, 0.7, 1.5, 2},
                  {3.2, 0, -0.2, 0.85, 0.8, 1.6, 2},
                  {4.4, 0, -0.1, 0.95, 0.8, 1.5, 2},
                  {5.0, 0, -0.15, 0.95, 0.8, 1.4, 2}};
  body.add(Loft(ridge, scale_sections(rows, s, false), 1.4 * s.length, 0.75 * s.length), 1.6 * s.length, false);
  body.add(ellipsoid(s, {0.95, 9.05, 160.25}, {0.75, 1.05, 0.72}, 0, 18), 0.8 * s.length, true);
  body.carve(ellipsoid(s, {0.58, 9.6, 159.4}, {0.36, 0.62, 0.5}, 0, 14), 0.3 * s.length, true);
}

void add_mouth(BlendedBody& body, const Scale& s) {
  // Convex region over the teeth, both lips with a groove between them, and chin.
  body.add(ellipsoid(s, {0, 7.0, 157.6}, {3.1, 2.1, 2.5}), 2.4 * s.length, false);
  body.add(ellipsoid(s, {0.8, 8.7, 157.78}, {1.75, 0.65, 0.5}, -10, 20), 0.4 * s.length, true);
  body.add(ellipsoid(s, {0, 8.65, 156.62}, {1.95, 0.7, 0.6}), 0.5 * s.length, false);
  body.carve(ellipsoid(s, {0, 9.65, 157.2}, {2.4, 0.85, 0.18}), 0.35 * s.length, false);
  body.add(ellipsoid(s, {0, 6.6, 154.7}, {2.1, 1.9, 1.5}), 2.6 * s.length, false);
}

void add_ears(BlendedBody& body, const Scale& s) {
  body.add(ellipsoid(s, {7.15, -1.6, 162.6}, {0.8, 1.65, 2.8}, -10, -20), 1.4 * s.length, true);
  body.carve(ellipsoid(s, {8.15, -1.15, 163.0}, {0.6, 0.9, 1.6}, -10, -20), 0.6 * s.length, true);
  body.add(ellipsoid(s, {6.9, -0.6, 162.1}, {0.6, 0.55, 0.8}, 0, -10), 0.6 * s.length, true);
}

/// Hair, combed back into a knot.
void add_hair(BlendedBody& body, const Scale& s) {
  const double cm = s.length;
  const auto cut = [cm](const Vec3& p) { return cm * hairline_distance(p.y() / cm, p.z() / cm); };
  body.add(ellipsoid(s, {0, -1.0, 165.9}, {7.75, 9.0, 9.1}, -4), 0.6 * s.length, false, cut);
  body.add(ellipsoid(s, {0, -kKnot.x(), kKnot.y()}, {3.2, 2.6, 3.1}, 14), 0.8 * s.length, false);
}

}  // namespace

double hairline_distance(double backward, double up) {
  const Vec2 p(backward, up);
  double nearest_sq = 1e9, height = kHairline[0].y();
  for (std::size_t i = 1; i < std::size(kHairline); ++i) {
    const Vec2 a = kHairline[i - 1], along = kHairline[i] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest_sq = std::min(nearest_sq, (a + t * along - p).squaredNorm());
    if (backward >= a.x()) height = a.y() + std::min((backward - a.x()) / along.x(), 1.0) * along.y();
  }
  return up > height ? -std::sqrt(nearest_sq) : std::sqrt(nearest_sq);
}

void add_head(BlendedBody& body, const Scale& s) {
  add_skull(body, s);
  add_eyes(body, s);
  add_nose(body, s);
  add_mouth(body, s);
  add_ears(body, s);
  add_hair(body, s);
}

}  // namespace weft::character
