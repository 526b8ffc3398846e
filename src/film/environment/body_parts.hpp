// Parts of a character: those that the scene lists, those that pins, obstacles or cameras follow, and hands, which do
// not collide by default if they have fingers.
#pragma once

#include <span>
#include <vector>

#include "film/environment/acting.hpp"
#include "film/environment/cast.hpp"

namespace weft::environment {

/// Finds the vertices of each part; adds a warning to `body` if its hands do not collide by default. Throws
/// Error(scene_invalid) for a part that holds no triangle, and for a name that is no part, joint, bone or material of
/// the body.
std::vector<Part> parts_of(const Cast& cast, const scene::Acting& acting, std::span<const FollowingPin> following,
                           Body& body);

}  // namespace weft::environment
