// The effective scene as text, and its hash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// Fills in `hash`, `simulation_hash` and `files`. The hash is 64-bit FNV-1a of the checked values of a scene, in which
/// file names lose their folders, and of the bytes of the files that for_each_dependency() visits. Scenes that differ
/// only in comments, order, spelling of numbers or explicit defaults have equal hashes. `simulation_hash` omits keys
/// that the rules mark as not simulated, such as colours, and files of pictures and cameras; it includes the duration
/// only if there are characters.
void identify(Scene& scene);

}  // namespace weft::scene
