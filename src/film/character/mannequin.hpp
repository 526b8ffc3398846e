// The built-in body: a mannequin of any size, build and resolution.
#pragma once

#include <array>

#include "film/character/character.hpp"
#include "film/character/joints.hpp"

namespace weft::character {

/// Build of a mannequin. The mannequin stands on z = 0 with z up, faces -y and has its left side at x > 0.
struct MannequinBuild {
  double height = 1.75;       ///< [m]
  double girth = 1;           ///< factor on widths and depths, except head, hands, feet; 0.8 to 1.5
  double masculinity = 0;     ///< 0: waist, hips and bust of a woman; 1: shoulders, chest and waist of a man
  double edge_length = 0.02;  ///< edge length of the triangles [m]; shorter where the body is thin or strongly curved

  bool operator==(const MannequinBuild&) const = default;
};

/// Positions of the joints in the rest pose [m]: arms 45° from the vertical, legs slightly apart.
std::array<Vec3, kJointCount> mannequin_joints(const MannequinBuild& build);

/// Makes the body. Its mesh is closed and exactly symmetric (bit for bit), with at most four influences per vertex.
/// Nodes and bones have the order of Joint. In the rest pose, the axes of all nodes are those of the world. Keeps a
/// copy of the last body until one with another build is made: a scene needs the same body several times.
Character make_mannequin(const MannequinBuild& build);

}  // namespace weft::character
