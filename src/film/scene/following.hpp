// Obstacles and cameras that follow the rigid motion of another body.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Whether an obstacle moves by prescribed motion: by two or more keys of its own or, if it follows a body directly or
/// through others, by the motion of that body. A character counts as moving. Motion by forces does not count.
bool moves(const Scene& scene, const Obstacle& obstacle);

/// Reports each `follow` key of an obstacle or camera that names no body, or a character but none of its parts ("man",
/// not "man.head"). For obstacles, also reports the first cycle, and each `follow` that names a dynamic obstacle.
void check_following(const Scene& scene, Findings& findings);

}  // namespace weft::scene
