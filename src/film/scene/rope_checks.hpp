// Checks of ropes beyond the rules of single keys.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Reports ropes whose start shape is not defined, ropes with pieces that are too short for contact or with the name of
/// a cloth, and too many particles.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
