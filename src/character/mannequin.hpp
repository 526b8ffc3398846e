// Our own body: a mannequin as in a shop window, of any size, build and resolution.
#pragma once

#include <array>

#include "character/character.hpp"
#include "character/joints.hpp"

namespace weft::character {

/// What a mannequin is like. It stands on z = 0 with z up, looks toward -y and has its left side at x > 0.
struct MannequinBuild {
  double height = 1.75;       ///< [m]
  double girth = 1;           ///< widths and depths against those of the slender default; 0.9 to 1.3
  double masculinity = 0;     ///< 0: waist, hips and bust of a woman, 1: shoulders, chest and waist of a man
  double edge_length = 0.02;  ///< of the triangles [m]; head, hands and feet have shorter ones
};

/// Where the joints are at rest [m]: arms 45° from the body, legs slightly apart.
std::array<Vec3, kJointCount> mannequin_joints(const MannequinBuild& build);

/// The body: closed, symmetric to the bit, with no more than four influences a vertex. Nodes are the joints in their
/// order, bones likewise, and at rest all of them have the axes of the world. Deterministic.
Character make_mannequin(const MannequinBuild& build);

}  // namespace weft::character
