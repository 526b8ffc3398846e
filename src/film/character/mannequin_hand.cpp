// A relaxed hand of the mannequin: palm, four fingers that bend toward the thigh, and thumb. Lengths are in
// centimetres.
#include <cmath>

#include "film/character/mannequin_parts.hpp"

namespace weft::character {
namespace {

/// A finger: position of its root along the arm and forward [cm], lengths of its two segments and radius [cm], bend at
/// the root and at the middle joint [degrees].
struct Finger {
  double at, forward, first, second, radius, root, middle;
};
constexpr Finger kRelaxedFingers[] = {
    {66.8, 2.6, 4.5, 4.2, 0.88, 13, 22},
    {67.2, 0.95, 4.9, 4.7, 0.90, 15, 24},
    {67.0, -0.75, 4.6, 4.4, 0.88, 17, 26},
    {66.3, -2.35, 3.8, 3.5, 0.82, 19, 28},
};
constexpr double kPlateRoot = 16,
                 kPlateTip = 41;  ///< bend of both plates [degrees]: mean bend of the fingers
constexpr double kClosing =
    0.040;  ///< slope of a finger toward the middle of the hand per distance from the middle [1/cm]

/// The frame at `from` with the axis `along`, and u as close as possible to `across`.
LoftFrame frame_along(const Vec3& from, const Vec3& along, const Vec3& across) {
  const Vec3 u = (across - across.dot(along) * along).normalized();
  return {from, along, u, along.cross(u)};
}

/// Adds a rod with round ends.
void add_rod(BlendedBody& body, const Scale& s, const LoftFrame& frame, double length, double radius, double end_radius,
             double blend) {
  const Rows rows{{0, 0, 0, radius, radius, radius, 2}, {length, 0, 0, end_radius, end_radius, end_radius, 2}};
  body.add(Loft(frame, scale_sections(rows, s, false), radius * s.length, end_radius * s.length), blend, true);
}

/// A flat body that fills the gaps between fingers: length, half widths at both ends, half thickness [cm].
struct Plate {
  double length, width, end_width, thickness;
};

void add_plate(BlendedBody& body, const Scale& s, const LoftFrame& frame, const Plate& plate) {
  const Rows rows{{0, 0, 0, plate.width, plate.thickness, plate.thickness, 2.5},
                  {plate.length, 0, 0, plate.end_width, plate.thickness, plate.thickness, 2.5}};
  body.add(Loft(frame, scale_sections(rows, s, false), 0.6 * s.length, 0.6 * s.length), 0.5 * s.length, true);
}

Vec3 bent(const Vec3& along, const Vec3& toward, double degrees) {
  const double angle = degrees * kDegree;
  return std::cos(angle) * along + std::sin(angle) * toward;
}

}  // namespace

void add_hand(BlendedBody& body, const Scale& s, const LoftFrame& arm) {
  const Rows palm{{57.5, 0, 0.3, 1.45, 2.1, 2.0, 2},
                  {60.5, 0.0, 0.3, 1.45, 2.6, 2.5, 2.1},
                  {63.5, -0.1, 0.25, 1.45, 3.3, 3.1, 2.2},
                  {66.0, -0.15, 0.2, 1.15, 3.4, 3.2, 2.3},
                  {67.6, -0.3, 0.15, 0.85, 3.2, 3.0, 2.3}};
  body.add(Loft(arm, scale_sections(palm, s, false), 2 * s.length, 1.4 * s.length), 2.5 * s.length, true);
  const auto place = [&](double at, double out, double forward) -> Vec3 {
    return arm.origin + s.length * (at * arm.along + out * arm.u + forward * arm.v);
  };
  const Vec3 inward = -arm.u;
  // Without the plates, the surfaces of neighbouring fingers would nearly touch, and triangles between them would fold.
  const Vec3 first_plate = bent(arm.along, inward, kPlateRoot), second_plate = bent(arm.along, inward, kPlateTip);
  const Vec3 knuckles = place(66.5, -0.1, 0.1);
  add_plate(body, s, frame_along(knuckles, first_plate, arm.v), {4.9, 3.1, 2.7, 0.55});
  add_plate(body, s, frame_along(knuckles + s.length * 4.9 * first_plate, second_plate, arm.v), {3.4, 2.7, 1.6, 0.5});
  for (const Finger& f : kRelaxedFingers) {
    const Vec3 ahead = (arm.along - kClosing * f.forward * arm.v).normalized();
    const Vec3 root = place(f.at, -0.1, f.forward), first = bent(ahead, inward, f.root);
    const Vec3 middle = root + s.length * f.first * first, second = bent(ahead, inward, f.root + f.middle);
    add_rod(body, s, frame_along(root, first, arm.v), f.first, f.radius, 0.96 * f.radius, 0.3 * s.length);
    add_rod(body, s, frame_along(middle, second, arm.v), f.second - 0.8 * f.radius, 0.96 * f.radius, 0.84 * f.radius,
            0.3 * s.length);
  }
  const Vec3 root = place(60.6, -0.7, 2.2), first = (0.78 * arm.along + 0.56 * arm.v - 0.3 * arm.u).normalized();
  const Vec3 middle = root + s.length * 4.3 * first;
  const Vec3 second = (0.92 * arm.along + 0.3 * arm.v - 0.3 * arm.u).normalized();
  add_rod(body, s, frame_along(root, first, arm.u), 4.3, 1.35, 1.0, 1.2 * s.length);
  add_rod(body, s, frame_along(middle, second, arm.u), 2.4, 1.0, 0.78, 0.4 * s.length);
}

}  // namespace weft::character
