// Parts of a character: those of the scene, those that its pins follow, and hands that are left out by themselves.
#pragma once

#include <span>
#include <vector>

#include "environment/acting.hpp"
#include "environment/cast.hpp"

namespace weft::environment {

/// Finds their vertices; says in the warnings of the body where hands are left out. Throws Error(scene_invalid) for
/// parts that hold no triangle, and for what is neither part, joint, bone nor material of it.
std::vector<Part> parts_of(const Cast& cast, const scene::Acting& acting, std::span<const FollowingPin> following,
                           Body& body);

}  // namespace weft::environment
