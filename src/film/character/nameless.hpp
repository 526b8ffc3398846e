// Finds joints of skeletons without meaningful names: from the tree, the lengths of bones, and the posture.
#pragma once

#include <array>
#include <vector>

#include "film/character/character.hpp"

namespace weft::character {

/// For each of joint_names() except the trunk below the neck, the node with that role; -1 if there is none.
/// - Legs and arms are the two pairs of longest chains that leave a common node and have nearly equal lengths left and
///   right. The legs are the pair whose common node is an ancestor of that of the other pair, else the longer pair.
/// - In a limb, upper and lower bone are the consecutive bones whose shorter one is longest, before the fingers branch
///   off. In arms, a pair farther out is preferred if its bones are not much shorter.
/// - Toes, knees and the vector from hips to shoulders determine the left side, as a mean over the first clip, or at
///   rest if there is none.
/// - Neck and head: the chain that reaches highest among the other children of the arms' common node.
/// Leaf nodes count only if they influence skin or move in a clip; end markers of bones do not.
/// All -1 if there are not two arms and two legs, or if the left side cannot be determined.
std::vector<Index> find_nameless_joints(const Character& character);

/// Nodes at which the index and the little finger begin; -1 if fewer than four chains leave the hand. The thumb is the
/// shortest chain. Of the others, index and little finger are farthest apart; the index is on the thumb's side.
std::array<Index, 2> find_knuckles(const Character& character, Index hand);

}  // namespace weft::character
