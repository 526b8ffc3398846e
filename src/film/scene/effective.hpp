// Hashes that identify a scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// Sets Scene::hash, Scene::simulation_hash and Scene::files.
/// - `hash`: 64-bit FNV-1a of the checked values, with file names without their folders, and of the content of the
///   files that for_each_dependency() visits. It does not depend on comments, order of keys, spelling of numbers, or
///   whether defaults are written.
/// - `simulation_hash`: the same, but without keys that the rules mark as not simulated, such as colours, and without
///   files of pictures and cameras. It depends on the duration only if there are characters.
void identify(Scene& scene);

}  // namespace weft::scene
