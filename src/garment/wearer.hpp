// The body that a garment is put on, and the tubes around its parts that panels are bent along.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::garment {

/// What a vertex of the skin is part of. Left and right are the wearer's.
enum class Region : std::uint8_t { trunk, left_arm, right_arm, left_leg, right_leg };

/// Joints of an arm, from shoulder to wrist, or of a leg, from hip to ankle [m].
using Limb = std::array<Vec3, 3>;

/// A body as it stands at the start, in its own axes: x to its left, y to its back, z up, the origin on the floor below
/// its hips [m].
struct Wearer {
  std::vector<Vec3> skin;
  std::vector<mesh::Triangle> triangles;
  std::vector<Region> regions;  ///< per vertex; neck and head belong to the trunk
  double neck = 0;              ///< height of the joint at its base [m]
  std::optional<Limb> left_arm, right_arm, left_leg, right_leg;
  Eigen::Isometry3d to_world = Eigen::Isometry3d::Identity();
};

/// What panels are bent around. torso and neck are one upright tube around all but the arms, of which head is the
/// widest section above the neck, all the way; body goes around the arms too and gets no narrower downward; legs go on
/// up to the neck around half of the trunk.
enum class Around { none, torso, body, neck, head, left_arm, right_arm, left_leg, right_leg };
inline const std::vector<std::string> kAroundNames = {"",         "torso",     "body",     "neck",     "head",
                                                      "left_arm", "right_arm", "left_leg", "right_leg"};

/// That of the other side.
Around mirrored(Around part);

/// A tube around a part: convex sections of the skin across an axis. Places on it are s along the axis [m], growing
/// toward the trunk, for upright parts the height above the floor, for arms from the shoulder; and a length along the
/// section, counter-clockwise seen from the trunk, or from above.
class Tube {
 public:
  /// Throws Error(scene_invalid) where the wearer's joints for it are not known.
  Tube(const Wearer& wearer, Around part);

  /// Sections are moved outward by a distance [m]; beyond the ends the tube goes on as it ends.
  double girth(double s, double outward) const;
  /// The place at a length from where the section faces an angle [rad]: 0 to the front, π/2 to the wearer's left.
  Vec3 at(double s, double angle, double length, double outward) const;
  /// Direction of growing s.
  Vec3 along(double s) const;
  double low() const { return first_; }
  double high() const { return first_ + kSpacing * static_cast<double>(sections_.size() - 1); }

 private:
  static constexpr double kSpacing = 0.01;  // of sections [m]; skin bends little within
  static constexpr int kDirections = 96;    // 4 mm apart on a chest
  /// Support function: how far the section reaches in each direction from a point of the axis.
  struct Section {
    Vec3 centre, front, left, along;
    std::array<double, kDirections> reach;
    double scale = 1;  // of lengths along it and outward, where the tube closes
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
