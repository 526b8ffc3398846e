// Checks of a scene that the rules of single keys cannot express.
#pragma once

#include "film/scene/findings.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Key path of the cloth with the index `cloth`. If a rope has made this cloth: key path of the rope.
const std::string& entry_of_cloth(const Scene& scene, std::size_t cloth, const Findings& findings);

/// Reports names that do not exist, names that objects of two kinds share, key frames that are not in time order,
/// unreadable pictures, and sizes and combinations that cannot be simulated.
void check(const Scene& scene, Findings& findings);

}  // namespace weft::scene
