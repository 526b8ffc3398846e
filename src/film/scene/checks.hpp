// Checks of a scene beyond the rules of single keys.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Key path of a cloth, or of the rope that the cloth represents.
const std::string& entry_of_cloth(const Scene& scene, std::size_t cloth, const Findings& findings);

/// Reports unknown and repeated names, key times out of order, unreadable pictures, and sizes and combinations that
/// cannot be simulated.
void check(const Scene& scene, Findings& findings);

}  // namespace weft::scene
