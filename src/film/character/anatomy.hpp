// Axes of body parts. They do not depend on the axes that the joints have in a file.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "film/character/character.hpp"
#include "film/character/joints.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// A character, and the nodes that are its joints. `joints`: for each of joint_names(), the node that is this joint; -1
/// if there is none.
struct Rig {
  const Character& character;
  std::span<const Index> joints;
};

/// Positions [m] and rotations of the joints in one pose, in world coordinates. A missing joint has the position 0 and
/// the identity rotation.
struct Posture {
  std::array<Vec3, kJointCount> places;
  std::array<Quat, kJointCount> rotations;
  std::array<Vec3, kJointCount> ends;  ///< mean position of the child nodes; position of the joint if it has no child
  /// Vectors from the index to the little finger, of the left and the right hand [m]; zero if unknown.
  std::array<Vec3, 2> knuckles;
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
  /// Vector from middle_of_hips() to the midpoint of the upper-arm joints. If one of these is missing: to the first
  /// existing joint of neck, head, chest and spine. If all are missing: bone() of the hips.
  Vec3 trunk(const Posture& posture) const;
  /// Height of the lowest of these joints [m]; infinite if all are missing. `up`: unit vector.
  double lowest_height(const Posture& posture, std::span<const Joint> joints, const Vec3& up) const;
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

/// Ratio of the sizes of two skeletons, body / motion: of their leg lengths; if one of them has no whole leg, of the
/// distances from the hips to the highest joint of the trunk that both have; 1 if both have no such joint. `rest`,
/// `first`: a posture of each.
double size_ratio(const Skeleton& body, const Posture& rest, const Skeleton& motion, const Posture& first);

/// Weights of the left and the right foot in one posture: 1 if the foot stands flat on the floor, 0 if not.
using Flat = std::array<double, 2>;

/// Finds, for each joint, the axes of its body part: a rotation from the coordinates of the part to those of the joint.
/// The rotation is the identity for missing joints, and for the foot and the toes of a leg without a knee joint. Axes
/// of body parts:
/// - Hips, spine, chest, neck and head: x to the left of the body, z up when the body stands upright.
/// - Shoulders: as the chest; without a chest, as the spine; without both, as the hips.
/// - Arms and legs: z along the bone, x along the hinge axis of elbow or knee.
/// - Hands: z along the bone, x out of the left palm and out of the back of the right hand. If the fingers are unknown,
///   x is as close as possible to the x axis of the lower arm.
/// - Feet and toes: z up when they are flat on the floor, x toward the toes.
/// Only positions of joints and fingers determine the axes in the world. The rest pose of a file and the pose with zero
/// angles have no effect. Each axis is a weighted mean over the postures. The weight of a posture is larger the more
/// upright it is (z axes of the trunk), the squared sine of the bend (hinges), `flat` (feet and toes), or 1 (all other
/// axes). If the mean weight is too small, a guess from the bone or from neighbouring joints gets the missing weight.
/// `flat`: one entry per posture. `up`: unit vector.
std::array<Quat, kJointCount> find_anatomy(const Skeleton& skeleton, std::span<const Posture> postures,
                                           std::span<const Flat> flat, const Vec3& up);

/// The rotation whose z axis has the direction of `z` and whose x axis is as close as possible to `x`. If `z` is 0, the
/// z axis is (0, 0, 1). If `x` is 0 or parallel to `z`, the x axis is any vector perpendicular to the z axis.
Quat axes_along(const Vec3& z, const Vec3& x);

}  // namespace weft::character
