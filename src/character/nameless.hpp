// Joints of skeletons whose names tell nothing: from the tree, the lengths of bones, and how it stands.
#pragma once

#include <array>
#include <vector>

#include "character/character.hpp"

namespace weft::character {

/// For each of joint_names() but those of the trunk below the neck the node that has its part, -1 where there is none.
/// - Legs and arms are the two pairs of longest chains that leave one node and have the same lengths left and right.
///   Legs leave nearer to the root, else they are the longer ones.
/// - In a limb upper and lower bone are the two longest that follow each other, before where fingers part.
/// - Toes, knees and the way from the hips to the shoulders say which side is the left, as a mean over the first clip,
///   or at rest where there is none.
/// - What else leaves the arms' node and goes farthest up is neck and head.
/// Nodes without any below count where they hold skin or move in a clip: ends of bones do not.
/// All -1 for what has not two arms and two legs, or where nothing tells the left.
std::vector<Index> find_nameless_joints(const Character& character);

/// Nodes where the index and the little finger begin; -1 where fewer than four chains leave the hand. The thumb
/// ends nearest to the hand; of the others index and little finger are farthest apart, the index finger on its side.
std::array<Index, 2> find_knuckles(const Character& character, Index hand);

}  // namespace weft::character
