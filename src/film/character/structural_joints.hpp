// Finds the joints of a skeleton without meaningful names, from its tree, the lengths of its bones and its posture.
#pragma once

#include <array>
#include <vector>

#include "film/character/character.hpp"

namespace weft::character {

/// For each of joint_names(), the node that is this joint; -1 if there is none. Hips, spine and chest are always -1. A
/// chain is the longest path of nodes from a node outward.
/// - Legs and arms are the two longest pairs of chains that leave a common node and have nearly equal lengths. The legs
///   are the pair whose common node is an ancestor of the common node of the other pair. If there is no such pair, the
///   legs are the longer pair.
/// - The upper and the lower bone of a limb are the two consecutive bones whose shorter one is longest, before the
///   fingers branch off. In arms, a pair of bones farther out is preferred if its bones are not much shorter.
/// - Toes, knees and the vector from hips to shoulders determine the left side, as a mean over the first clip; without
///   a clip, in the rest pose.
/// - Neck and head: the chain that reaches highest among the other children of the common node of the arms.
/// Leaf nodes that neither influence skin nor move in a clip are end markers of bones and do not count. The result is
/// all -1 if there are not two arms and two legs, or if the left side cannot be determined.
std::vector<Index> find_joints_by_structure(const Character& character);

/// First nodes of the index and the little finger; -1 if fewer than four chains of at least two nodes leave the hand,
/// or if the two shortest of them are equal, as in hands of cartoons. The thumb is the shortest chain. Index and little
/// finger are the two other chains whose first nodes are farthest apart; the index is on the side of the thumb.
std::array<Index, 2> find_knuckles(const Character& character, Index hand);

}  // namespace weft::character
