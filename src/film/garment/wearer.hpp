// The body that wears a garment, and tubes around its parts that panels are bent along.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {

/// Body part of a skin vertex. Left and right are the wearer's.
enum class Region : std::uint8_t { trunk, left_arm, right_arm, left_leg, right_leg };

/// Joints of an arm, from shoulder to wrist, or of a leg, from hip to ankle [m].
using Limb = std::array<Vec3, 3>;

/// Height of the joint at the base of the neck, as a fraction of the body height, of the mannequin. Patterns are drawn
/// for such bodies.
inline constexpr double kNeckHeightRatio = 0.83;

/// A body at the start, in its own axes: x to its left, y to its back, z up, origin on the floor below its hips [m].
struct Wearer {
  std::vector<Vec3> skin;
  std::vector<mesh::Triangle> triangles;
  std::vector<Region> regions;  ///< per vertex; neck and head belong to the trunk
  double neck = 0;              ///< height of the joint at the base of the neck [m]
  std::optional<Limb> left_arm, right_arm, left_leg, right_leg;
  Eigen::Isometry3d to_world = Eigen::Isometry3d::Identity();
};

/// Part that panels are bent around. The tube of torso and neck is upright and goes around all but the arms. The tube
/// of the head has the head's widest section everywhere, and narrows to a dome above. The tube of the body also goes
/// around the arms and never narrows downward. The tube of a leg continues up to the neck, around half of the trunk.
enum class Around { none, torso, body, neck, head, left_arm, right_arm, left_leg, right_leg };
inline const std::vector<std::string> kAroundNames = {"",         "torso",     "body",     "neck",     "head",
                                                      "left_arm", "right_arm", "left_leg", "right_leg"};

/// The same part on the other side.
Around mirrored(Around part);

/// A tube around a part: convex sections of the skin across an axis. Coordinates on the tube: s along the axis, and a
/// length along the section [m]. s increases toward the trunk: for upright parts, it is the height above the floor; for
/// arms, it is 0 at the shoulder and negative below. The length runs counter-clockwise seen from the trunk or from
/// above.
class Tube {
 public:
  /// Throws Error(scene_invalid) if the wearer lacks the joints or the skin for the part.
  Tube(const Wearer& wearer, Around part);

  /// Girth at s, with sections moved outward by a distance [m]. The end sections continue beyond the ends of the tube.
  /// In the dome of a hood, the girth is that of the section before it narrows.
  double girth(double s, double outward) const;
  /// The point at a length along the section from the point that faces an angle [rad]: 0 to the front, π/2 to the
  /// wearer's left.
  Vec3 at(double s, double angle, double length, double outward) const;
  /// Direction of increasing s.
  Vec3 along(double s) const;
  double low() const { return first_; }
  double high() const { return first_ + kSpacing * static_cast<double>(sections_.size() - 1); }

 private:
  static constexpr double kSpacing = 0.01;  // distance between sections [m], over which the skin bends little
  static constexpr int kDirections = 96;    // directions of a section, 10 mm apart on a chest
  /// A convex section by its support function: the extent from the centre in each direction.
  struct Section {
    Vec3 centre, front, left, along;
    std::array<double, kDirections> support;
    double scale = 1;  // factor on lengths along the section and outward; below 1 in the dome of a hood
  };
  using Ring = std::array<Vec3, kDirections>;

  std::optional<Section> cut(const Wearer& wearer, const std::vector<mesh::Triangle>& skin, const Section& plane) const;
  Section section(double s) const;
  static double length(const Ring& points);
  static Ring ring(const Section& section, double outward);

  double first_ = 0;  // s of the first section
  std::vector<Section> sections_;
};

}  // namespace weft::garment
