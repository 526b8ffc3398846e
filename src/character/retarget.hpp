// The motion of one skeleton on another.
#pragma once

#include <span>

#include "character/character.hpp"

namespace weft::character {

/// A skeleton and its node for each of joint_names(); -1 where it has none.
struct Rig {
  const Character& character;
  std::span<const Index> joints;
};

/// A clip that moves `body` as `clip` moves `motion`. Both skeletons must have Hips; other joints count where both have
/// them. A joint turns against its rest pose, in world directions, as its counterpart does, after limbs of the body
/// have been laid along those of the motion's rest pose, so that a body in T-pose follows a motion in A-pose; both are
/// taken to face the same way at rest. Hips travel by the ratio of the legs' lengths, from where the body stands, such
/// that the lowest foot of the clip is as high as the feet of the body at rest. `up`: unit vector.
Clip retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up);

}  // namespace weft::character
