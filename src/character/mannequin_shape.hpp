// The surface of the mannequin, apart from its triangles.
#pragma once

#include "character/loft.hpp"
#include "character/mannequin.hpp"

namespace weft::character {

/// Negative inside [m].
BlendedBody mannequin_body(const MannequinBuild& build);

}  // namespace weft::character
