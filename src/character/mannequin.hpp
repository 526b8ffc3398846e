// Our own body: a mannequin as in a shop window, of any size, build and resolution.
#pragma once

#include <array>
#include <string_view>

#include "character/character.hpp"

namespace weft::character {

/// What a mannequin is like. It stands on z = 0 with z up, looks toward -y and has its left side at x > 0.
struct MannequinBuild {
  double height = 1.75;       ///< [m]
  double girth = 1;           ///< widths and depths against those of the slender default; 0.9 to 1.3
  double masculinity = 0;     ///< 0: waist, hips and bust of a woman, 1: shoulders, chest and waist of a man
  double edge_length = 0.02;  ///< of the triangles [m]; head, hands and feet have shorter ones
};

/// Joints, parents first. Those of the left side are followed by their mirror images on the right.
enum class Joint {
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

std::string_view name(Joint joint);
/// The parent; hips are their own.
Joint parent(Joint joint);

/// Where the joints are at rest [m]: arms 45° from the body, legs slightly apart.
std::array<Vec3, kJointCount> mannequin_joints(const MannequinBuild& build);

/// The body: closed, symmetric to the bit, with no more than four influences a vertex. Nodes are the joints in their
/// order, bones likewise, and at rest all of them have the axes of the world. Deterministic.
Character make_mannequin(const MannequinBuild& build);

}  // namespace weft::character
