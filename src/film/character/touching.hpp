// Keeps hands in contact: retargeted hands stay as near to other parts of the body as in the motion.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "film/character/anatomy.hpp"

namespace weft::character {

using Places = std::array<Vec3, kJointCount>;

/// Ratios of lengths of a body to those of a motion, and the length of the motion's arm from shoulder to wrist [m].
struct Proportions {
  double arm = 1, trunk = 1;
  double their_arm = 0;
};

/// Displacements of the left and the right hand [m]. They give each hand the position that it has in the motion, scaled
/// to the body, relative to the other hand, the other elbow and the hips. They apply fully up to a distance of 7 to 22
/// cm (touching.cpp), then fade, and vanish at twice that distance. They are continuous in all positions, so contact
/// intervals need not be detected. The hips count only for hands that rest on them and arms that are bent, not for
/// hanging arms. `theirs`: joints of the motion, rotated to the heading of the body. `both`: joints that both skeletons
/// have; an arm moves only if its hand, elbow and shoulder are among them. `rests`: weight 0 to 1 of each hand resting
/// on the hips.
std::array<Vec3, 2> displace_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                                   const Proportions& proportions, const std::array<double, 2>& rests);

/// Weight with which each hand rests on the hips, per posture. Within 0.1 s to either side, the hand moves relative to
/// the hips by less than 0.09 `arm`: 1; by more than 0.18 `arm`, as in running: 0. `arm`: length from shoulder to wrist
/// [m]. `times`: increasing [s].
std::vector<std::array<double, 2>> find_resting_hands(std::span<const Posture> postures, std::span<const double> times,
                                                      double arm);

}  // namespace weft::character
