// The surface of the mannequin, apart from its triangles.
#pragma once

#include "character/loft.hpp"
#include "character/mannequin.hpp"

namespace weft::character {

/// Height that the tables of the body are given for [cm].
inline constexpr double kTableHeight = 175;

/// Negative inside [m].
BlendedBody mannequin_body(const MannequinBuild& build);

}  // namespace weft::character
