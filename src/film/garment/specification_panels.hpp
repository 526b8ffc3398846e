// Panels and stitches of a GarmentCode specification, before their conversion to a Pattern.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "film/garment/pattern.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// One edge of the outline of a panel, in the coordinates of the panel [m].
struct SpecEdge {
  Vec2 start, end;
  std::vector<Vec2> control;              // inner control points; empty: straight line or arc
  double radius = 0;                      // radius of a circular arc [m]; 0: no arc
  bool large_arc = false, sweep = false;  // flags of an SVG arc, for y upward
  bool has_length() const { return (end - start).norm() > kRoundoff; }
};

/// A stitch that joins two edges: edge[0] of panel[0] and edge[1] of panel[1] (indices).
struct SpecStitch {
  std::array<std::size_t, 2> panel, edge;
  bool right_wrong = false;  // the outer (right) side of one panel continues the inner (wrong) side of the other
};

/// A panel of the specification. "Drawing": its flat outline; "in space": as placed around the body of the file.
struct SpecPanel {
  std::string name, words;  // words: name and label, in lower case
  std::vector<SpecEdge> edges;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation{0, 0, 0};  // [m]
  // The members below are derived: derive_geometry() sets points, mirrored, outward, middle and area;
  // find_turned_panels() sets turned; the reader (specification.cpp) sets around, limbs_to_trunk and worn.
  std::vector<std::vector<Vec2>> points;  // per edge: sample points from its start, without its end [m]
  bool mirrored = false;                  // whether it is drawn clockwise, that is, as seen from the inside
  Vec3 outward{0, 0, 1};                  // normal that points away from the body
  Vec3 middle{0, 0, 0};                   // middle of the bounding box of the outline, in space [m]
  Around around = Around::torso;
  // Number of limb panels between this one and the trunk. -1: this is no limb panel, or no chain of stitches joins it
  // to the trunk.
  int limbs_to_trunk = -1;
  double area = 0;      // [m²]
  bool turned = false;  // folded over like a lapel; see Panel::turned
  // Map from the drawing to the panel when worn, seen from outside.
  Eigen::Affine2d worn = Eigen::Affine2d::Identity();

  Vec3 in_space(const Vec2& p) const { return rotation * Vec3(p.x(), p.y(), 0) + translation; }
  bool is_limb() const { return around >= Around::left_arm; }
  bool is_leg() const { return around == Around::left_leg || around == Around::right_leg; }
};

/// SVG path data of the outline, transformed by `map`, which must preserve lengths (radii are not scaled).
std::string path_of(const SpecPanel& panel, const Eigen::Affine2d& map);

/// Sets `points`, `mirrored`, `outward`, `middle` and `area` from the edges and the placement of a panel.
void derive_geometry(SpecPanel& panel);

/// The measures of `body`, with the girths of the panels where these are narrower. `floor`: height of the floor in
/// space [m]. Requires SpecPanel::around and SpecPanel::turned.
/// - Hip: at most the width of the panels around the trunk at the height of the hips.
/// - Chest, if the garment ends nearer to the neck than to the waist: at most the largest such width above the waist.
/// - Waist, if it ends lower: at most the length of its upper rim.
/// Panels that are much narrower than a girth do not surround the body; they do not change this girth.
Measures limit_to_panels(const Measures& body, std::span<const SpecPanel> panels, std::span<const SpecStitch> stitches,
                         double floor);

/// Sets `turned` of all panels. The right_wrong stitches divide each connected set of panels into two sides; the panels
/// on the side with the smaller total area are turned. If a closed chain of stitches would turn a panel over, returns
/// the index of a stitch of this chain; otherwise returns nothing.
std::optional<std::size_t> find_turned_panels(std::span<SpecPanel> panels, std::span<const SpecStitch> stitches);

}  // namespace weft::garment
