// The effective scene as text, and its hash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace weft::scene {

/// 64-bit FNV-1a of everything that decides what a scene shows: its checked values and the bytes of the files it
/// depends on, but not the folders they are in. Equal for scenes that differ in comments, order, spelling of numbers or
/// given defaults.
std::uint64_t hash_of(const Scene& scene);

}  // namespace weft::scene
