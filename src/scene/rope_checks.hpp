// What ropes must fulfil beyond the rules of single keys.
#pragma once

#include "scene/findings.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Reports ropes without a course, and pieces that are shorter than contact allows.
void check_ropes(const Scene& scene, Findings& findings);

}  // namespace weft::scene
