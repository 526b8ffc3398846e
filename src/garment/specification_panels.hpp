// Panels and stitches of a specification of GarmentCode, as they are drawn there.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "garment/wearer.hpp"

namespace weft::garment {

/// One side of a panel; coordinates are those of the panel [m].
struct SpecEdge {
  Vec2 start, end;
  std::vector<Vec2> control;          // of a Bézier curve, if any
  double radius = 0;                  // of an arc, if not 0
  bool large = false, right = false;  // as in SVG, y upward
  bool has_length() const { return (end - start).norm() > 1e-9; }
};

/// A stitch from one edge to another.
struct SpecStitch {
  std::array<std::size_t, 2> panel, edge;
  bool right_wrong = false;  // the right side of one is continued by the wrong side of the other
};

struct SpecPanel {
  std::string name, words;  // words: label and name, in small letters
  std::vector<SpecEdge> edges;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation{0, 0, 0};  // [m]
  // What follows from these.
  std::vector<std::vector<Vec2>> points;  // along each edge
  bool mirrored = false;                  // drawn as seen from within
  Vec3 outward{0, 0, 1};
  Vec3 middle{0, 0, 0};  // in space
  Around around = Around::torso;
  int steps = -1;                                      // of a limb: stitches to the trunk
  double area = 0;                                     // [m²]
  bool turned = false;                                 // worn with what would be its inside outward, as a lapel
  Eigen::Affine2d worn = Eigen::Affine2d::Identity();  // from the drawing to it as worn, but for the position

  Vec3 in_space(const Vec2& p) const { return rotation * Vec3(p.x(), p.y(), 0) + translation; }
  bool limb() const { return around >= Around::left_arm; }
};

/// SVG path data of a panel whose points are moved by `map`.
std::string path_of(const SpecPanel& panel, const Eigen::Affine2d& map);

/// Finds the points, front, middle and area of a panel. Around its front edges run counter-clockwise.
void look_at(SpecPanel& panel);

/// Finds which panels are turned: of those that are sewn together, the smaller area of the two sides of the stitches
/// that say right_wrong. Returns a stitch at which a ring of stitches turns a panel over, where there is one.
std::optional<std::size_t> turn_over(std::span<SpecPanel> panels, std::span<const SpecStitch> stitches);

}  // namespace weft::garment
