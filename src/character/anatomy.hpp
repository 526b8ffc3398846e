// Skeletons by the parts that their joints have in a body, whatever axes the joints themselves have.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "character/character.hpp"
#include "character/joints.hpp"
#include "character/pose.hpp"

namespace weft::character {

/// A skeleton and its node for each of joint_names(); -1 where it has none.
struct Rig {
  const Character& character;
  std::span<const Index> joints;
};

/// Where the joints of a skeleton are at a moment, in the world. What is said of joints that it has not means nothing.
struct Posture {
  std::array<Vec3, kJointCount> places;
  std::array<Quat, kJointCount> rotations;
  std::array<Vec3, kJointCount> ends;  ///< mean place of the nodes right below a joint; its own where there are none
  std::array<Vec3, 2> knuckles;        ///< from the index to the little finger, left and right; zero without them
};

class Skeleton {
 public:
  explicit Skeleton(const Rig& rig);

  bool has(Joint joint) const { return rig_.joints[place_of(joint)] >= 0; }
  Posture at(const Pose& pose) const;

  /// From a joint to the next that it has: along limbs outward, along the trunk upward, at their ends to what hangs
  /// there; zero if that is nothing.
  Vec3 bone(const Posture& posture, Joint joint) const;
  /// From the right side of the body to the left; zero where a skeleton has neither legs nor arms in pairs.
  Vec3 across_hips(const Posture& posture) const;
  Vec3 across_shoulders(const Posture& posture) const;
  /// Between the hip joints; that of the hips without legs.
  Vec3 middle_of_hips(const Posture& posture) const;
  /// From between the hip joints to between the shoulders, or as far up as the trunk goes.
  Vec3 trunk(const Posture& posture) const;
  /// Mean length of the legs from hip to ankle; 0 if there are none.
  double leg_length(const Posture& posture) const;
  /// Mean length of the arms from shoulder to wrist; 0 if one is not whole.
  double arm_length(const Posture& posture) const;

 private:
  Vec3 across(const Posture& posture, Joint left) const;

  const Rig rig_;
  std::array<std::vector<Index>, kJointCount> children_;  // nodes right below a joint
  std::array<std::array<Index, 2>, 2> fingers_{};         // nodes of index and little finger, left and right; or -1
};

/// How flat the left and the right foot stand on the floor in a posture, 0 or 1.
using Flat = std::array<double, 2>;

/// For each joint the rotation from its axes in a body to its own axes. In a body,
/// - hips, spine, chest, neck and head have x to their left and z up when they stand upright; shoulders the chest's;
/// - arms and legs have z along the bone and x along the axis about which elbow and knee bend; hands likewise, x out of
///   the left palm and into the back of the right hand;
/// - feet and toes have z up when they are flat on the floor, and x toward the toes.
/// Found from places alone, as means over all postures in which they show: the trunk when it stands, hinges as far as
/// they are bent, feet where they are flat; so neither the pose in which a file begins nor that of its zero angles
/// matters. What never shows is guessed from neighbouring joints. `flat`: as many as postures. `up`: unit vector.
std::array<Quat, kJointCount> find_anatomy(const Skeleton& skeleton, std::span<const Posture> postures,
                                           std::span<const Flat> flat, const Vec3& up);

/// The rotation whose z axis is that of the first direction and whose x axis comes closest to the second.
Quat axes_along(const Vec3& z, const Vec3& x);

}  // namespace weft::character
