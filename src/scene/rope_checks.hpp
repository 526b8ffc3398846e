// Checks of ropes beyond the rules of single keys.
#pragma once

#include "scene/findings.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Reports ropes whose course is not defined, and pieces that are too short for contact.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
