// Transfers the motion of one skeleton to another.
#pragma once

#include <string>
#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/character.hpp"

namespace weft::character {

/// The result of retarget().
struct Retargeted {
  Clip clip;
  std::vector<std::string> warnings;  ///< about the rest pose of the body, and about implausible motion
};

/// Makes a clip that moves `body` as `clip` moves `motion`. Both skeletons must have Hips. Any other joint moves if
/// both skeletons have it. If the motion lacks the spine or the neck but has the neighbouring joints, that joint of the
/// body gets the rotation halfway between these. If the motion lacks toes, the toes of the body follow the foot.
/// - If the skeletons differ, directions and twists of bones are transferred relative to the axes of find_anatomy(), so
///   that the rest pose of the motion has no effect. In its rest pose, the body must stand upright with its feet flat
///   on the floor. At time 0, the body has the heading of its rest pose. The travel of the hips is scaled by
///   size_ratio() and starts at the position of the body. Feet keep the contacts of the motion (footing.hpp).
/// - If the skeletons are the same (joint positions equal up to one common factor), all rotations are copied, including
///   the heading. If the nodes above the hips have different rotations, the motion is first rotated about `up`, so that
///   both skeletons have the same heading in their rest poses. The lowest foot of the motion gets the height of the
///   lowest foot of the body in its rest pose.
/// `up`: unit vector.
Retargeted retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up);

/// Mean of the unit vector along Skeleton::trunk(), from the hips to the shoulders, over the keys of a clip; zero
/// without Hips.
Vec3 mean_trunk(const Rig& motion, const Clip& clip);

}  // namespace weft::character
