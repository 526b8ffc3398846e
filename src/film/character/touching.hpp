// Keeps hands in contact: moves retargeted hands as near to other parts of the body as they are in the motion.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// Positions of all joints [m].
using Places = std::array<Vec3, kJointCount>;

/// Ratios of lengths, body / motion.
struct Proportions {
  double arm = 1, trunk = 1;
  double their_arm = 0;  ///< length of the arm of the motion, from shoulder to wrist [m]
};

/// Displacements of the left and the right hand [m]. A displacement restores the offset of the hand from a target that
/// it has in the motion, scaled to the body. Targets are the other hand, the other elbow and, if the hand rests on the
/// hips and the arm is bent, the hips. The displacement applies fully if the wrist of the motion is within a limit of
/// the target: 7 to 22 cm for an arm of 0.55 m (touching.cpp). Beyond the limit, it fades to 0 at twice the limit. It
/// is a continuous function of all positions, so that intervals of contact need not be detected. `theirs`: joints of
/// the motion, rotated to the heading of the body. `ours`: joints of the body. `both`: joints that both skeletons have;
/// a hand moves only if the hand, lower-arm and upper-arm joints of its side are among them. `rests`: weight, 0 to 1,
/// of each hand resting on the hips.
std::array<Vec3, 2> displace_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                                   const Proportions& proportions, const std::array<double, 2>& rests);

/// Weight with which each hand rests on the hips, per posture. It depends on the distance by which the hand moves
/// relative to the hips within 0.1 s before and after: 1 for less than 0.09 `arm`; 0 for more than 0.18 `arm`, as in
/// running. `arm`: length from shoulder to wrist [m]. `times`: of the postures, increasing [s].
std::vector<std::array<double, 2>> find_resting_hands(std::span<const Posture> postures, std::span<const double> times,
                                                      double arm);

}  // namespace weft::character
