// Horizontal travel of a clip: unchanged, in place, or at a given speed.
#pragma once

#include "film/character/anatomy.hpp"
#include "film/character/character.hpp"

namespace weft::character {

/// Removes the travel of a clip: subtracts the horizontal path of the hips, smoothed over about two steps. The clip
/// then begins and ends at the same position. Sway about the path remains. `up`: unit vector.
Clip remove_travel(const Rig& rig, const Clip& clip, const Vec3& up);

/// The result of set_travel_speed().
struct TravelResult {
  Clip clip;
  double feet = 0;  ///< mean speed of feet in stance, relative to the body [m/s]; 0 if it is too slow for a walk
};

/// Replaces the travel of a clip by travel with the mean speed `speed` [m per second of clip time], along the path that
/// its feet in stance imply. Feet do not slide if `speed` equals TravelResult::feet. If TravelResult::feet is 0, the
/// clip moves straight ahead. `up`: unit vector.
TravelResult set_travel_speed(const Rig& rig, const Clip& clip, double speed, const Vec3& up);

}  // namespace weft::character
