// The implicit surface of the mannequin, before triangulation.
#pragma once

#include "film/character/loft.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {

/// Height of the body in the tables [cm].
inline constexpr double kTableHeight = 175;

/// The body as a field [m], negative inside. Its feet extend below the floor, z = 0.
BlendedBody mannequin_body(const MannequinBuild& build);

}  // namespace weft::character
