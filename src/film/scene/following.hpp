// Obstacles and cameras that follow the rigid motion of another body.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Whether the scene prescribes a motion of an obstacle: the obstacle has two or more key frames; or it follows,
/// directly or through other obstacles, a character or an obstacle with two or more key frames. Motion by forces does
/// not count.
bool has_prescribed_motion(const Scene& scene, const Obstacle& obstacle);

/// Reports each `follow` of an obstacle or camera that does not name a body, or that names a character without a part
/// ("man" instead of "man.head"). For obstacles, also reports each `follow` that names a dynamic obstacle
/// (is_dynamic()), and the first cycle of obstacles that follow each other.
void check_following(const Scene& scene, Findings& findings);

}  // namespace weft::scene
