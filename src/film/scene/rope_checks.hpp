// Checks of ropes beyond the rules of single keys.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Reports ropes whose start shape is not defined, and ropes with pieces that are too short for contact.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
