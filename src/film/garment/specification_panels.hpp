// Panels and stitches of a GarmentCode specification, as drawn there.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// One edge of the outline of a panel, in the coordinates of the panel [m].
struct SpecEdge {
  Vec2 start, end;
  std::vector<Vec2> control;              // inner control points of a Bézier curve; empty: none
  double radius = 0;                      // of a circular arc; 0: no arc
  bool large_arc = false, sweep = false;  // flags large-arc and sweep of an SVG arc, y upward
  bool has_length() const { return (end - start).norm() > 1e-9; }
};

/// A stitch from one edge to another.
struct SpecStitch {
  std::array<std::size_t, 2> panel, edge;
  bool right_wrong = false;  // the right side of one panel continues the wrong side of the other
};

struct SpecPanel {
  std::string name, words;  // words: label and name, in lower case
  std::vector<SpecEdge> edges;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation{0, 0, 0};  // [m]
  // Derived from the members above.
  std::vector<std::vector<Vec2>> points;  // along each edge, without its end
  bool mirrored = false;                  // drawn as seen from the inside
  Vec3 outward{0, 0, 1};
  Vec3 middle{0, 0, 0};  // of the bounding box of the outline, in space [m]
  Around around = Around::torso;
  int limbs_to_trunk = -1;  // number of limb panels between this one and the trunk; -1: unknown
  double area = 0;          // [m²]
  bool turned = false;      // folded over as a lapel; see Panel::turned
  Eigen::Affine2d worn = Eigen::Affine2d::Identity();  // map from drawing to panel as worn, without its position

  Vec3 in_space(const Vec2& p) const { return rotation * Vec3(p.x(), p.y(), 0) + translation; }
  bool is_limb() const { return around >= Around::left_arm; }
};

/// SVG path data of a panel whose points are transformed by `map`.
std::string path_of(const SpecPanel& panel, const Eigen::Affine2d& map);

/// Derives points, orientation, outward direction, middle and area of a panel from its edges.
void derive_geometry(SpecPanel& panel);

/// Finds the turned panels. The right_wrong stitches split each connected set of panels into two sides; the panels of
/// the side with the smaller area are turned. Returns the index of a stitch that contradicts the two sides, if any:
/// following a closed chain of stitches would turn a panel over.
std::optional<std::size_t> find_turned_panels(std::span<SpecPanel> panels, std::span<const SpecStitch> stitches);

}  // namespace weft::garment
