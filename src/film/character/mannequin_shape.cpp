// Cross-sections of the mannequin in centimetres, for a height of 175 cm; all sizes scale with the height. Heights of
// the joints and lengths of the segments are those of Drillis & Contini, "Body Segment Parameters" (1966), as fractions
// of the height in Winter, "Biomechanics and Motor Control of Human Movement", Fig. 4.1; see mannequin_joints(). Girths
// are about one clothing size smaller than the mean of women in ANSUR II (Gordon et al., "2012 Anthropometric Survey of
// U.S. Army Personnel", 2014), as those of shop-window mannequins are. All other sizes are estimates.
#include "film/character/mannequin_shape.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "film/character/mannequin_parts.hpp"

namespace weft::character {
namespace {

/// Adds the trunk from hips to collar bones. Depths are measured from the plane through ears, shoulders, hips and
/// ankles.
void add_torso(BlendedBody& body, const Scale& s) {
  const auto w = [&](double woman, double man) { return s.blend(woman, man); };
  const Rows rows{
      {82, 0, 0, w(8.0, 7.6), 6.6, 7.0, 2},
      {85.5, 0, 0, w(12.2, 11.6), 8.2, 8.6, 2.1},
      {89.5, 0, 0, w(15.4, 14.6), 9.2, 9.7, 2.2},
      {94, 0, 0, w(16.35, 15.6), 9.7, 10.0, 2.2},
      {100, 0, 0, w(15.1, 15.1), w(9.9, 10.4), 8.9, 2.25},
      {106, 0, 0, w(13.1, 14.6), w(9.4, 10.4), w(7.6, 8.0), 2.25},
      {111, 0, 0, w(12.0, 14.3), w(9.0, 10.4), w(6.8, 7.8), 2.3},
      {116, 0, 0, w(12.3, 14.8), w(9.2, 10.6), w(7.4, 8.6), 2.3},
      {122, 0, 0, w(13.4, 15.6), w(9.7, 11.2), w(8.7, 10.0), 2.3},
      {128, 0, 0, w(14.2, 16.2), w(9.4, 11.4), w(9.7, 11.2), 2.35},
      {133, 0, 0, w(14.4, 16.2), w(8.2, 10.4), w(10.0, 11.4), 2.4},
      {138, 0, 0, w(13.0, 15.0), w(6.6, 8.2), w(9.4, 10.8), 2.3},
      {141, 0, 0, w(11.6, 13.2), w(5.6, 6.8), w(8.8, 9.8), 2.2},
  };
  body.add(Loft({}, scale_sections(rows, s), 3 * s.length, 6 * s.length), 0.01, false);
}

/// An ellipsoid whose half axes scale with the girth (those of ellipsoid() scale with the height). `middle`: its
/// centre, as components to the left, forward and up.
Loft ball(const Scale& s, const Vec3& middle, double side, double depth, double half_height) {
  const LoftFrame frame{s.length * Vec3(middle.x(), -middle.y(), middle.z())};
  const double cap = half_height * s.girth;
  return Loft(frame, {{0, 0, 0, side * s.girth, depth * s.girth, depth * s.girth, 2}}, cap, cap);
}

void add_bust_and_seat(BlendedBody& body, const Scale& s) {
  const double bust = s.blend(1, 0.72);
  body.add(
      ball(s, {7.2, s.blend(7.0, 7.2), s.blend(126.2, 129)}, 6.0 * s.blend(1, 1.15), 5.8 * bust, 6.2 * s.blend(1, .8)),
      0.06, true);
  body.add(ball(s, {7.8, -4.8, 88.0}, 7.6, 7.4 * s.blend(1, 0.92), 9.0), 0.06, true);
}

/// Adds the shoulders, from the neck along the collar bones; u is up, v forward.
void add_shoulders(BlendedBody& body, const Scale& s) {
  const double wide = s.blend(1, 1.2);
  const Rows rows{
      {0, 141.8, -2.6, 6.6, 6.6, 6.2, 2},           {6 * wide, 141.2, -2.4, 6.2, 6.4, 6.0, 2},
      {11 * wide, 140.2, -1.9, 5.3, 5.8, 5.6, 2},   {14.5 * wide, 139.2, -1.5, 4.7, 5.2, 5.1, 2},
      {15.5 * wide, 138.9, -1.4, 4.6, 5.0, 5.0, 2},
  };
  LoftFrame frame;
  frame.along = Vec3::UnitX();
  frame.u = Vec3::UnitZ();
  body.add(Loft(frame, scale_sections(rows, s), 5 * s.length, 4.6 * s.length), 0.06, true);
}

void add_neck(BlendedBody& body, const Scale& s) {
  // The neck is inclined forward by `lean` [rad]. Its base between the shoulders is at position 0 of the axis.
  LoftFrame neck;
  neck.origin = s.length * Vec3(0, 2.9, 143);
  const double lean = 0.27;
  neck.along = Vec3(0, -std::sin(lean), std::cos(lean));
  neck.v = Vec3(0, -std::cos(lean), -std::sin(lean));
  const double k = s.blend(1, 1.14);
  const Rows rows{{0, 0, 0, 6.2 * k, 5.6 * k, 5.6 * k, 2},
                  {4, 0, 0, 5.5 * k, 5.3 * k, 5.3 * k, 2},
                  {8, 0, 0, 5.0 * k, 5.1 * k, 5.2 * k, 2},
                  {12, 0, 0, 4.95 * k, 5.2 * k, 5.3 * k, 2},
                  {16, 0, 0, 5.3 * k, 5.6 * k, 5.6 * k, 2}};
  body.add(Loft(neck, scale_sections(rows, s), 3 * s.length, 3 * s.length), 0.05, false);
}

/// Frame with the axis along the arm, from the shoulder on; u points away from the body, v forward.
LoftFrame arm_frame(const Vec3& shoulder, const Vec3& wrist) {
  LoftFrame frame;
  frame.origin = shoulder;
  frame.along = (wrist - shoulder).normalized();
  frame.u = frame.v.cross(frame.along).normalized();
  return frame;
}

void add_arm(BlendedBody& body, const Scale& s, const LoftFrame& frame) {
  const double k = s.blend(1, 1.18);
  Rows arm{{1, -0.5, 0, 4.1, 4.6, 4.6, 2}, {6, 0.1, 0, 4.4, 4.8, 4.8, 2},  {12, 0.1, 0, 4.0, 4.6, 4.5, 2},
           {18, 0, 0, 3.7, 4.3, 4.0, 2},   {25, 0, 0, 3.4, 3.7, 3.6, 2},   {32, 0, 0, 3.35, 3.4, 3.6, 2},
           {37, 0, 0.2, 3.6, 3.8, 3.7, 2}, {42, 0, 0.3, 3.4, 3.6, 3.4, 2}, {49, 0, 0.3, 2.7, 2.9, 2.8, 2},
           {55, 0, 0.3, 2.1, 2.5, 2.4, 2}, {59, 0, 0.3, 1.9, 2.6, 2.5, 2}};
  for (Section& row : arm) {
    row.side *= k;
    row.front *= k;
    row.back *= k;
  }
  body.add(Loft(frame, scale_sections(arm, s), 4.4 * s.length, 2 * s.length), 0.045, true);
}

void add_leg(BlendedBody& body, const Scale& s) {
  const double k = s.blend(1, 1.02);
  Rows leg{
      {5, 11.0, -1.3, 2.7, 3.2, 3.5, 2},   {9, 11.0, -1.3, 2.75, 3.1, 3.3, 2},  {14, 10.95, -1.2, 2.75, 3.0, 3.2, 2},
      {21, 10.85, -1.1, 3.4, 3.5, 4.0, 2}, {28, 10.75, -1.1, 4.5, 4.2, 5.3, 2}, {34, 10.65, -1.0, 5.15, 4.6, 6.0, 2},
      {40, 10.5, -0.7, 5.0, 4.6, 5.6, 2},  {46, 10.3, -0.1, 4.6, 5.0, 4.9, 2},  {50, 10.2, 0.2, 4.8, 5.4, 4.7, 2},
      {55, 10.1, 0.3, 5.3, 5.9, 5.2, 2},   {62, 9.9, 0.5, 6.3, 7.1, 6.4, 2},    {70, 9.75, 0.5, 7.3, 8.1, 7.5, 2},
      {77, 9.4, 0.2, 7.8, 8.5, 8.3, 2},    {83, 8.8, 0, 8.0, 8.4, 8.4, 2},      {87, 8.4, 0, 7.7, 8.1, 8.1, 2},
      {92, 7.6, 0, 6.7, 7.2, 7.2, 2},      {97, 6.8, 0, 5.4, 6.0, 6.0, 2}};
  for (Section& row : leg) {
    row.side *= k;
    row.front *= k;
    row.back *= k;
    // Heavier thighs are farther apart.
    row.u += (s.girth / s.length - 1) * row.side * std::min(1.0, row.at / 78);
  }
  body.add(Loft({}, scale_sections(leg, s), 3.5 * s.length, 4 * s.length), 0.06, true);
}

/// Adds a foot. The axis runs from the heel to the toes, slightly outward; u is to the side, v up.
void add_foot(BlendedBody& body, const Scale& s, const Vec3& ankle) {
  LoftFrame frame;
  const double out = 0.1;
  frame.origin = Vec3(ankle.x(), ankle.y(), 0);
  frame.along = Vec3(std::sin(out), -std::cos(out), 0);
  frame.u = Vec3(std::cos(out), std::sin(out), 0);
  frame.v = Vec3::UnitZ();
  // In these rows, the fifth value is the extent above the centre, the sixth the extent below it.
  const Rows rows{{-3.0, 0, 2.6, 2.7, 4.0, 3.4, 2.3},   {0, 0, 2.6, 3.0, 5.4, 3.4, 2.2},
                  {4, 0.1, 2.4, 3.2, 4.9, 3.2, 2.2},    {8, 0.2, 2.1, 3.7, 3.8, 2.9, 2.2},
                  {12, 0.1, 1.7, 4.3, 2.7, 2.5, 2.3},   {15, 0, 1.5, 4.4, 1.9, 2.2, 2.4},
                  {17.6, -0.5, 1.3, 3.9, 1.4, 1.9, 2.4}};
  body.add(Loft(frame, scale_sections(rows, s, false), 2.6 * s.length, 2.4 * s.length), 0.03, true);
}

}  // namespace

Rows scale_sections(Rows rows, const Scale& scale, bool grows) {
  const double across = grows ? scale.girth : scale.length;
  for (Section& s : rows) {
    s.at *= scale.length;
    s.u *= scale.length;
    s.v *= scale.length;
    s.side *= across;
    s.front *= across;
    s.back *= across;
  }
  return rows;
}

Loft ellipsoid(const Scale& scale, const Vec3& middle, const Vec3& half, double pitch, double yaw) {
  const Eigen::AngleAxisd nod(pitch * kDegree, Vec3::UnitX()), turn(yaw * kDegree, Vec3::UnitZ());
  LoftFrame frame{scale.length * Vec3(middle.x(), -middle.y(), middle.z())};
  frame.along = turn * (nod * frame.along);
  frame.u = turn * (nod * frame.u);
  frame.v = turn * (nod * frame.v);
  const double side = half.x() * scale.length, depth = half.y() * scale.length, cap = half.z() * scale.length;
  return Loft(frame, {{0, 0, 0, side, depth, depth, 2}}, cap, cap);
}

BlendedBody mannequin_body(const MannequinBuild& build) {
  Scale scale;
  scale.length = build.height / kTableHeight;
  scale.girth = scale.length * build.girth;
  scale.masculinity = build.masculinity;
  const auto joints = mannequin_joints(build);
  const auto at = [&](Joint j) { return joints[joint_index(j)]; };

  BlendedBody body;
  add_torso(body, scale);
  add_bust_and_seat(body, scale);
  add_shoulders(body, scale);
  add_neck(body, scale);
  body.begin_group();
  add_head(body, scale);
  body.begin_group();
  const LoftFrame arm = arm_frame(at(Joint::left_upper_arm), at(Joint::left_hand));
  add_arm(body, scale, arm);
  body.begin_group();
  add_hand(body, scale, arm);
  body.begin_group();
  add_leg(body, scale);
  add_foot(body, scale, at(Joint::left_foot));
  return body;
}

}  // namespace weft::character
