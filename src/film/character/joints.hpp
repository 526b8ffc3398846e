// The joints of a human body, and their names in common rigs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "film/character/character.hpp"

namespace weft::character {

/// Joints in the order trunk, left side, right side (the mirror image of the left). Parents precede their children.
enum class Joint : std::uint8_t {
  hips,
  spine,
  chest,
  neck,
  head,
  left_shoulder,
  left_upper_arm,
  left_lower_arm,
  left_hand,
  left_upper_leg,
  left_lower_leg,
  left_foot,
  left_toes,
  right_shoulder,
  right_upper_arm,
  right_lower_arm,
  right_hand,
  right_upper_leg,
  right_lower_leg,
  right_foot,
  right_toes,
};
inline constexpr std::size_t kJointCount = 21;
inline constexpr std::size_t kSideJointCount = 8;  ///< number of joints on each side

constexpr std::size_t joint_index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

/// The joint `left` of the left side or, if `right`, its mirror image.
constexpr Joint on_side(Joint left, bool right) {
  return static_cast<Joint>(joint_index(left) + (right ? kSideJointCount : 0));
}

/// The joints of both feet.
inline constexpr std::array kFootJoints{Joint::left_foot, Joint::left_toes, Joint::right_foot, Joint::right_toes};

std::string_view name(Joint joint);
/// The parent joint. The hips are their own parent.
Joint parent(Joint joint);

/// Names in the order of Joint: Hips, Spine, Chest, Neck, Head, then for Left and Right: Shoulder, UpperArm, LowerArm,
/// Hand, UpperLeg, LowerLeg, Foot, Toes.
const std::vector<std::string>& joint_names();

/// The name in lower case, without underscores, so that "LeftUpperArm" and "left_upper_arm" are equal.
std::string normalise_word(const std::string& name);

/// Index of a name in joint_names(), compared by normalise_word(); -1 for other names.
Index joint_number(const std::string& name);

/// For each of joint_names(), the node that is this joint; -1 if there is none. Finds nodes by the names of common rigs
/// (a table in joints.cpp). If both upper arms and both upper legs are found, the nodes at which they branch off
/// determine hips, spine and chest instead. Ignores case, separators, the name of a rig before a colon, and words such
/// as Bip01 or bone. If several nodes have the same name, the first active one counts, or the first one if none is
/// active. `is_active`: per node, whether it influences skin or moves; empty: all are active.
std::vector<Index> find_named_joints(std::span<const Node> nodes, const std::vector<bool>& is_active = {});

/// Like find_named_joints(), but also handles rigs whose node names share a prefix or suffix, such as the name of the
/// rig. If not all upper and lower arms and legs are found by name, the structure of the tree determines the missing
/// joints (structural_joints.hpp).
std::vector<Index> find_joints(const Character& character);

}  // namespace weft::character
