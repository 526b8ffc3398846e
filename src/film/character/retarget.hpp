// Transfers the motion of one skeleton to another.
#pragma once

#include <string>
#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/character.hpp"

namespace weft::character {

struct Retargeted {
  Clip clip;
  std::vector<std::string> warnings;  ///< warnings about the rest pose and implausible motions, with numbers
};

/// Makes a clip that moves `body` as `clip` moves `motion`. Both skeletons must have Hips; other joints move if both
/// have them. If the motion lacks the spine or the neck, that joint of the body gets the rotation halfway between those
/// of its neighbours; if it lacks toes, those of the body follow the foot. Bones get the directions and the twist of
/// the bones of the motion, relative to the axes of find_anatomy(), so that the rest pose of the motion does not
/// matter. The rest pose of the body must stand upright with its feet flat on the floor; at time 0 the body faces the
/// same way as at rest. The travel of the hips is scaled by the ratio of the leg lengths and starts at the body's own
/// position; feet keep the contacts of the motion (footing.hpp). A motion of the same skeleton (joint positions equal
/// up to one ratio) is instead copied rotation by rotation, its heading included, with its lowest foot at the height of
/// the body's feet at rest. `up`: unit vector.
Retargeted retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up);

/// Mean over a clip of the direction of Skeleton::trunk(), from the hips to the shoulders; zero without Hips.
Vec3 mean_trunk(const Rig& motion, const Clip& clip);

}  // namespace weft::character
