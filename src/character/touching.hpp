// Keeps hands in touch: parts that are near a hand in a motion stay as near on another body.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "character/anatomy.hpp"

namespace weft::character {

using Places = std::array<Vec3, kJointCount>;

/// Ratios of lengths of a body to those of a motion, and the length of the motion's arm from shoulder to wrist [m].
struct Proportions {
  double arm = 1, trunk = 1;
  double their_arm = 0;
};

/// Displacements of the left and the right hand that give them the same position, relative to the other hand, the other
/// elbow and the hips, as in the motion, scaled to the body. They apply fully within about a hand's length of these,
/// fade with distance and vanish at twice the distance. They are continuous in all positions, so there are no contact
/// intervals to detect. The hips count only for hands that rest on them and arms that are bent, not for hanging arms.
/// `theirs`: joints of the motion, rotated to the heading of the body. `both`: joints that both have; an arm moves only
/// if its hand, elbow and shoulder are among them. `rests`: weight 0 to 1 of each hand resting on the hips.
std::array<Vec3, 2> displace_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                                   const Proportions& proportions, const std::array<double, 2>& rests);

/// Weight with which each hand rests on the hips, per posture: 1 if it stays within a hand's breadth for a moment, 0 if
/// it moves twice as far, as in running. `arm`: length from shoulder to wrist [m]. `times`: increasing [s].
std::vector<std::array<double, 2>> find_resting_hands(std::span<const Posture> postures, std::span<const double> times,
                                                      double arm);

}  // namespace weft::character
