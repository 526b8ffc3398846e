// The joints of a human body and what the usual rigs call them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "character/character.hpp"

namespace weft::character {

/// Hips, Spine, Chest, Neck, Head, and for Left and Right: Shoulder, UpperArm, LowerArm, Hand, UpperLeg, LowerLeg,
/// Foot, Toes.
const std::vector<std::string>& joint_names();

/// Place of a name in joint_names(); -1 for others.
Index joint_number(const std::string& name);

/// For each of joint_names() the node that has its part, -1 where there is none, by the names of our mannequin, CMU and
/// Poser BVH, Mixamo, Biped ("Bip01"), Unreal and Blender rigs. Prefixes, case, spaces and underscores do not count.
std::vector<Index> find_joints(std::span<const Node> nodes);

}  // namespace weft::character
