// Bodies that follow the rigid motion of another one.
#pragma once

#include "scene/findings.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Whether an obstacle ever moves: by its own keys, or by those of a body that it follows, directly or through others.
/// A character counts as moving; forces do not count.
bool moves(const Scene& scene, const Obstacle& obstacle);

/// Reports each `follow` of an obstacle or camera that names no body, or a character without a part. For obstacles,
/// also reports a `follow` of a body that forces move, and the first cycle.
void check_following(const Scene& scene, Findings& findings);

}  // namespace weft::scene
