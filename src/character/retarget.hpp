// The motion of one skeleton on another.
#pragma once

#include <string>
#include <vector>

#include "character/anatomy.hpp"
#include "character/character.hpp"

namespace weft::character {

struct Retargeted {
  Clip clip;
  std::vector<std::string> doubts;  ///< what no body does, with figures
};

/// A clip that moves `body` as `clip` moves `motion`. Both skeletons must have Hips; other joints count where both have
/// them, and spine and neck go halfway where the motion has none. Bones point where those of the motion point and turn
/// about themselves as those do, by the axes of find_anatomy(), so that rest poses of the motion do not matter; that of
/// the body is to stand upright, feet flat on the floor. The body faces at time 0 where it faces at rest. Hips travel
/// by the ratio of the legs' lengths, from where the body stands; feet keep the contacts of the motion (footing.hpp).
///
/// A motion of the same skeleton, by the places of its joints up to one ratio, is taken over turn by turn, with its
/// lowest foot as high as those of the body at rest. `up`: unit vector.
Retargeted retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up);

/// The mean over a clip of the direction from the hips to between the shoulders; zero without a trunk.
Vec3 mean_trunk(const Rig& motion, const Clip& clip);

}  // namespace weft::character
