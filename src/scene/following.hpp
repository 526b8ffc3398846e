// Bodies that follow the rigid motion of another one.
#pragma once

#include "scene/findings.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Whether an obstacle ever moves: by its own keys, or by a body that it follows, directly or through others. A
/// character counts as moving.
bool moves(const Scene& scene, const Obstacle& obstacle);

/// Reports each `follow` of an obstacle or camera that names nothing or no part of a character, or closes a cycle of
/// obstacles.
void check_following(const Scene& scene, Findings& findings);

}  // namespace weft::scene
