// Finds the joints of a skeleton without meaningful names, from its tree, the lengths of its bones and its posture.
#pragma once

#include <array>
#include <vector>

#include "film/character/character.hpp"

namespace weft::character {

/// For each of joint_names(), the node with that role; -1 if there is none. Hips, spine and chest are always -1. A
/// chain is the longest path of nodes from a node outward.
/// - Legs and arms are the two longest pairs of chains that leave a common node and have nearly equal lengths. The legs
/// are the pair whose common node is an ancestor of the common node of the arms; if neither is an ancestor of the
/// other, the longer pair.
/// - In a limb, the upper and the lower bone are the two consecutive bones whose shorter one is longest, before the
/// fingers branch off. In arms, a pair of bones farther out is preferred if its bones are not much shorter.
/// - The left side follows from toes, knees and the vector from hips to shoulders, as a mean over the first clip, or at
/// rest if there is no clip.
/// - Neck and head: the chain that reaches highest among the other children of the common node of the arms.
/// Leaf nodes that neither influence skin nor move in a clip are end markers of bones and do not count.
/// All -1 if there are not two arms and two legs, or if the left side cannot be determined.
std::vector<Index> find_joints_by_structure(const Character& character);

/// First nodes of the index and the little finger; -1 if fewer than four chains of at least two
/// nodes leave the hand. The thumb is the shortest chain. Of the other chains, index and little
/// finger are the two whose first nodes are farthest apart; the index is on the side of the thumb.
std::array<Index, 2> find_knuckles(const Character& character, Index hand);

}  // namespace weft::character
