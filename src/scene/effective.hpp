// The effective scene as text, and its hash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace weft::scene {

/// Fills in `hash`, `simulation_hash` and `files`. The hash is 64-bit FNV-1a of everything that determines what a scene
/// shows: its checked values and the bytes of the files it depends on, but not their folders. Scenes that differ only
/// in comments, order, spelling of numbers or explicit defaults have equal hashes. `simulation_hash` leaves out keys
/// that the rules mark as not simulated, such as colours.
void identify(Scene& scene);

}  // namespace weft::scene
