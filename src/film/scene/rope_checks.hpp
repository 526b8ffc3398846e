// Checks of ropes that the rules of single keys cannot express.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Reports ropes without a start path, with pieces too short for contact or the name of a cloth, and too many
/// particles.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
