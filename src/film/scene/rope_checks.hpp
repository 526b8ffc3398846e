// Checks of ropes that the rules of single keys cannot express.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Reports each rope that has no valid start path, that has pieces shorter than kMinRopePiece at the start or at a key
/// frame, or that has the name of a cloth. Also reports if all ropes together have too many particles.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
