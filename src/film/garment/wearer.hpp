// The body that wears a garment, and the tubes around its parts on which panels start.
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

/// Heights of the joint at the base of the mannequin's neck and of its waist, as fractions of the body height. The
/// bodies for which patterns are drawn are assumed to have the same ratios.
inline constexpr double kNeckHeightRatio = 0.83, kWaistHeightRatio = 0.63;

/// A body at the start, in its own axes: x to its left, y to its back, z up, origin on the floor below its hips [m].
struct Wearer {
  std::vector<Vec3> skin;
  std::vector<mesh::Triangle> triangles;
  std::vector<Region> regions;  ///< per vertex; neck and head belong to the trunk
  double neck = 0;              ///< height of the joint at the base of the neck [m]
  std::optional<Limb> left_arm, right_arm, left_leg, right_leg;
  Eigen::Isometry3d to_world = Eigen::Isometry3d::Identity();
};

/// Power of two that is nearest to `ratio` on a logarithmic scale; 1 if `ratio` is not above 0. Lengths that are
/// multiplied by it keep their bits apart from the exponent.
double nearest_power_of_two(double ratio);

/// Factor on lengths that are chosen for people, such as the distance between sections: nearest_power_of_two() of the
/// wearer's height / 1.7 m. It is 1 for heights from 1.21 to 2.40 m.
double size_factor(const Wearer& wearer);

/// Part of the body around which a panel starts bent. The tubes of the parts:
/// - torso, neck: with a vertical axis, around the body without the arms;
/// - body: with a vertical axis, around the body with the arms; each section contains the section above it;
/// - head: with a vertical axis; all sections equal the widest section of the head, but above its height, they narrow
///   to a dome;
/// - arm: around the arm alone;
/// - leg: around the leg and, from the hip to the neck, around the same half of the trunk.
enum class Around { none, torso, body, neck, head, left_arm, right_arm, left_leg, right_leg };
inline const std::vector<std::string> kAroundNames = {"",         "torso",     "body",     "neck",     "head",
                                                      "left_arm", "right_arm", "left_leg", "right_leg"};

inline bool is_arm(Around part) {
  return part == Around::left_arm || part == Around::right_arm;
}

/// The part on the other side of the body; parts in the middle stay the same.
Around mirrored(Around part);

/// A tube around a part of the body, made of convex sections of the skin across an axis. A point of the tube has two
/// coordinates [m]: s along the axis, and a length along the section. s increases toward the trunk. For vertical axes,
/// s is the height above the floor; for legs, the length along the axis from the floor; for arms, s is 0 at the
/// shoulder and negative below. The length increases counter-clockwise, seen from the trunk or from above.
class Tube {
 public:
  /// Throws Error(scene_invalid) if the wearer lacks the joints or the skin for the part, or if the tube would be
  /// longer than kMaxLength (wearer.cpp).
  Tube(const Wearer& wearer, Around part);

  /// Girth [m] of the section at s, moved outward by `outward` [m]. Beyond the ends of the tube, the sections are those
  /// at the ends. In the dome of the head, the result is the girth before narrowing.
  double girth(double s, double outward) const;
  /// The point at `length` along the section at s, moved outward by `outward` [m]. `length` [m] is measured from the
  /// direction `angle` [rad]: 0 is the front, π/2 the wearer's left. In the dome of the head, `length` and `outward`
  /// are reduced as much as the section.
  Vec3 at(double s, double angle, double length, double outward) const;
  /// Direction of increasing s; a unit vector.
  Vec3 along(double s) const;
  /// s of the lower and of the upper end [m].
  double low() const { return first_; }
  double high() const { return first_ + spacing_ * static_cast<double>(sections_.size() - 1); }
  /// Distance between sections [m].
  double spacing() const { return spacing_; }

 private:
  static constexpr int kDirections = 96;  // number per section; points on a chest are then 10 mm apart
  /// A convex section, given by its support function: the extent from the centre in each direction.
  struct Section {
    Vec3 centre, front, left, along;
    std::array<double, kDirections> support;
    double scale = 1;  // factor on lengths along the section and outward; below 1 in the dome
  };
  using Ring = std::array<Vec3, kDirections>;

  std::optional<Section> cut(const Wearer& wearer, const std::vector<mesh::Triangle>& skin, const Section& plane) const;
  Section section(double s) const;
  static double length(const Ring& points);
  static Ring ring(const Section& section, double outward);

  double first_ = 0;       // s of the first section
  double spacing_ = 0.01;  // distance between sections [m], times size_factor(); the skin hardly changes over it
  std::vector<Section> sections_;
};

}  // namespace weft::garment
