// Axes of body parts, independent of the axes of the joints in a file.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "film/character/character.hpp"
#include "film/character/joints.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// A character, and the nodes that are its joints. `joints`: for each of joint_names(), the node with that role; -1 if
/// there is none.
struct Rig {
  const Character& character;
  std::span<const Index> joints;
};

/// Positions and rotations of the joints in one pose, in world coordinates. The values of missing joints are
/// meaningless.
struct Posture {
  std::array<Vec3, kJointCount> places;
  std::array<Quat, kJointCount> rotations;
  std::array<Vec3, kJointCount> ends;  ///< mean position of the child nodes; position of the joint if it has no child
  std::array<Vec3, 2> knuckles;        ///< of the left and the right hand: from index to little finger; zero: unknown
};

/// Directions and lengths of the limbs and the trunk of a rig, in given postures.
class Skeleton {
 public:
  explicit Skeleton(const Rig& rig);

  bool has(Joint joint) const { return rig_.joints[joint_index(joint)] >= 0; }
  Posture at(const Pose& pose) const;

  /// Vector from a joint to the next existing joint, outward along a limb or upward along the trunk. If there is no
  /// next joint: vector to the mean position of the child nodes of `joint`; zero if it has no child.
  Vec3 bone(const Posture& posture, Joint joint) const;
  /// Vector from the right upper-leg joint to the left one; zero if one is missing.
  Vec3 across_hips(const Posture& posture) const;
  /// Vector from the right upper-arm joint to the left one. If one is missing: from the right shoulder joint to the
  /// left one; zero if one of these is missing, too.
  Vec3 across_shoulders(const Posture& posture) const;
  /// Midpoint between the upper-leg joints; position of Joint::hips if one of them is missing.
  Vec3 middle_of_hips(const Posture& posture) const;
  /// Vector from middle_of_hips() to the midpoint of the upper-arm joints. If one of these is missing: to the neck,
  /// else the head, the chest or the spine. If all of these are missing: bone() of the hips.
  Vec3 trunk(const Posture& posture) const;
  /// Mean length (thigh plus shin) of the legs that have hip, knee and ankle joints; 0 if there is no such leg.
  double leg_length(const Posture& posture) const;
  /// Mean length of the arms, upper arm plus forearm; 0 if an upper-arm, elbow or hand joint is missing.
  double arm_length(const Posture& posture) const;

 private:
  Vec3 across(const Posture& posture, Joint left) const;

  const Rig rig_;
  std::array<std::vector<Index>, kJointCount> children_;  // child nodes of each joint
  std::array<std::array<Index, 2>, 2> fingers_{};  // nodes of index and little finger, left and right; -1: unknown
};

/// Weights of the left and the right foot in one posture: 1 if the foot stands flat on the floor, 0 if not.
using Flat = std::array<double, 2>;

/// Finds the axes of the body part of each joint, as a rotation from the coordinates of the part to those of the joint.
/// Axes of body parts:
/// - Hips, spine, chest, neck and head: x to the left of the body, z up when the body stands upright. Shoulders: as the
/// chest.
/// - Arms and legs: z along the bone, x along the hinge axis of elbow or knee.
/// - Hands: z along the bone, x out of the left palm and out of the back of the right hand.
/// - Feet and toes: z up when they are flat on the floor, x toward the toes.
/// Only positions of joints determine the axes in the world; the rest pose of a file and the pose with zero angles have
/// no effect. Each axis is a mean over the postures that determine it: upright postures for the trunk, all postures for
/// a hinge (weighted by its bend), postures with a flat foot for the foot. If postures determine an axis too weakly, a
/// guess from neighbouring joints complements it. `flat`: one entry per posture. `up`: unit vector.
std::array<Quat, kJointCount> find_anatomy(const Skeleton& skeleton, std::span<const Posture> postures,
                                           std::span<const Flat> flat, const Vec3& up);

/// The rotation whose z axis points along `z` and whose x axis is as close as possible to `x`.
Quat axes_along(const Vec3& z, const Vec3& x);

}  // namespace weft::character
