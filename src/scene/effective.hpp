// The effective scene as text, and its hash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace weft::scene {

/// Fills in `hash`, `simulation_hash` and `files`. The hash is 64-bit FNV-1a of everything that decides what a scene
/// shows: its checked values and the bytes of the files it depends on, but not the folders they are in. Equal for
/// scenes that differ in comments, order, spelling of numbers or given defaults. That of the simulation leaves out what
/// the rules call not simulated, such as colours.
void identify(Scene& scene);

}  // namespace weft::scene
