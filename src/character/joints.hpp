// The joints of a human body and what the usual rigs call them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "character/character.hpp"

namespace weft::character {

/// Joints, parents first. Those of the left side are followed by their mirror images on the right.
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
inline constexpr std::size_t kSideJointCount = 8;  ///< of one side

constexpr std::size_t place_of(Joint joint) {
  return static_cast<std::size_t>(joint);
}

/// A joint of the left side, or its mirror image.
constexpr Joint on_side(Joint left, bool right) {
  return static_cast<Joint>(place_of(left) + (right ? kSideJointCount : 0));
}

std::string_view name(Joint joint);
/// The parent; hips are their own.
Joint parent(Joint joint);

/// Hips, Spine, Chest, Neck, Head, and for Left and Right: Shoulder, UpperArm, LowerArm, Hand, UpperLeg, LowerLeg,
/// Foot, Toes.
const std::vector<std::string>& joint_names();

/// Place of a name in joint_names(); -1 for others.
Index joint_number(const std::string& name);

/// For each of joint_names() the node that has its part, -1 where there is none, by the names of the usual rigs (a
/// table in joints.cpp). Prefixes, case, spaces and underscores do not count. Hips, spine and chest are where limbs
/// part.
std::vector<Index> find_named_joints(std::span<const Node> nodes);

/// The same, also where many names begin with that of their rig and a mark; and where names leave out upper or lower
/// arms or legs what the tree says (nameless.hpp).
std::vector<Index> find_joints(const Character& character);

}  // namespace weft::character
