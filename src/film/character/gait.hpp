// Walk clips for the mannequin, made from fitted curves.
#pragma once

#include "film/character/character.hpp"

namespace weft::character {

/// A walk from standing to standing, along -y from the origin.
struct Walk {
  double speed = 1.2;      ///< steady walking speed [m/s]; 0.6 to 1.6
  double distance = 6;     ///< [m]; > 0; takes at least two steps
  bool turn_back = false;  ///< at the end, turn around on a small arc and walk back
  double stand = 0.5;      ///< standing time before and after [s]
  double arms_out = 13;    ///< angle of the upper arms from the vertical [degrees]; clearance for sleeves and skirts
};

/// Makes a walk. Feet keep their footholds (see Feet), the body balances above them (see balance_body), and all else
/// follows the curves of namespace walking (gait_curves.hpp). `mannequin`: made by make_mannequin, of any build. The
/// clip has about sixty keys per second, such that a step has a whole number of them.
Clip make_walk(const Character& mannequin, const Walk& walk);

}  // namespace weft::character
