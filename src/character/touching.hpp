// Hands that touch: what is near them in a motion stays as near on another body.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "character/anatomy.hpp"

namespace weft::character {

using Places = std::array<Vec3, kJointCount>;

/// Lengths of a body by those of a motion, and the arm of the motion from shoulder to wrist [m].
struct Proportions {
  double arm = 1, trunk = 1;
  double their_arm = 0;
};

/// The ways by which the left and the right hand come to be, from each other, the other elbow and the hips, where those
/// of the motion are, in the proportions of the body: wholly where they are within a hand's length, by less farther
/// away, by nothing at twice the distance. Continuous in all places, so that contacts have no beginning and no end that
/// could be missed. Hips are touched by hands that rest against them, and not by those of nearly straight arms, which
/// hang. `theirs`: of the motion, turned to where the body faces. `both`: joints that both have; hands, elbows and
/// shoulders of an arm must be among them for it to move. `rests`: of the left and the right hand against the hips, 0
/// to 1.
std::array<Vec3, 2> pull_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                               const Proportions& proportions, const std::array<double, 2>& rests);

/// For each posture how far hands rest against the hips: 1 where they stay within a hand's breadth for a moment, 0
/// where they go twice as far, as in those who run. `arm`: length from shoulder to wrist [m]. `times`: increasing [s].
std::vector<std::array<double, 2>> find_rests(std::span<const Posture> postures, std::span<const double> times,
                                              double arm);

}  // namespace weft::character
