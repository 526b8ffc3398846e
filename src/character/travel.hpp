// How a clip goes over the floor: as it is, in place, or at a speed.
#pragma once

#include "character/anatomy.hpp"
#include "character/character.hpp"

namespace weft::character {

/// The clip without its way: the level path of the hips, smoothed over a step, is taken out, what sways about it stays.
/// It begins and ends in one place.
Clip in_place(const Rig& rig, const Clip& clip, const Vec3& up);

struct Traveled {
  Clip clip;
  double feet = 0;  ///< mean speed at which feet that stand pass below a body in place [m/s]; 0: they do not
};

/// The clip with a way of `speed` [m/s of the clip] in the mean: that which keeps standing feet where they are, where
/// that is its speed. Ahead where no feet tell. A way of its own is taken out first. `up`: unit vector.
Traveled at_speed(const Rig& rig, const Clip& clip, double speed, const Vec3& up);

}  // namespace weft::character
