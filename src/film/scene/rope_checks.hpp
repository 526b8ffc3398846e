// Checks of ropes that the rules of single keys cannot express.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Reports each rope that has no valid start path, pieces shorter than kMinRopePiece, or the name
/// of a cloth. Also reports too many particles of all ropes together.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
