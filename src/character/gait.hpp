// Walking, made from fitted curves: the mannequin's clips.
#pragma once

#include "character/character.hpp"

namespace weft::character {

/// A walk from standing to standing, along -y from the origin.
struct Walk {
  double speed = 1.2;      ///< of even walking [m/s]; 0.6 to 1.6
  double distance = 6;     ///< [m]; at least two steps
  bool turn_back = false;  ///< at the end turn round on a small arc and walk back
  double stand = 0.5;      ///< before and after [s]
  double arms_out = 13;    ///< of the upper arms from the vertical [degrees]; room for sleeves and skirts
};

/// Feet stand where they stand (see Feet), the body is balanced above them (see lay_track); the rest follows the curves
/// of `walking`. `mannequin` is one of make_mannequin, of any build. Sixty keys a second, or nearly: a step takes a
/// whole number of them.
Clip make_walk(const Character& mannequin, const Walk& walk);

}  // namespace weft::character
