// Walk clips for the mannequin, made from curves that are fitted to motion capture.
#pragma once

#include "film/character/character.hpp"

namespace weft::character {

/// A walk that begins at the origin, goes along -y, and begins and ends with standing.
struct Walk {
  double speed = 1.2;      ///< steady walking speed, 0.6 to 1.6 [m/s]
  double distance = 6;     ///< one way, > 0 [m]; a walk has at least two steps
  bool turn_back = false;  ///< whether the body then turns around on a small arc and walks back
  double stand = 0.5;      ///< standing time before the first and after the last step [s]
  double arms_out = 13;    ///< mean outward angle of the upper arms from the vertical [degrees]
};

/// Makes a walk. Feet stay on their footholds (Feet, gait_feet.hpp), the body balances above the feet (balance_body,
/// gait_track.hpp), and all other angles follow the curves of namespace walking (gait_curves.hpp). `mannequin`: of any
/// build, made by make_mannequin(). The clip has about 60 keys per second; the exact rate makes the number of keys per
/// step even.
Clip make_walk(const Character& mannequin, const Walk& walk);

}  // namespace weft::character
