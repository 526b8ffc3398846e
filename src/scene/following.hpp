// Bodies that take part in the rigid motion of another one.
#pragma once

#include "scene/findings.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Whether an obstacle is ever moved: by keys of its own, or by what it follows, at any remove. A character counts as
/// moving.
bool moves(const Scene& scene, const Obstacle& obstacle);

/// Reports each `follow` of an obstacle or camera that names nothing, no part of a character, or a circle of obstacles.
void check_following(const Scene& scene, Findings& findings);

}  // namespace weft::scene
