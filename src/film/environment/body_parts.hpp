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

/// A number for each vertex, the same for those of one connected component and one character::Limb. Shells that
/// overlap, such as a pouch on a belt, have buried faces, which face into the other shell; as limbs of their own, they
/// do not decide where the outside of the other one is.
std::vector<Index> shells_of_limbs(const Cast& cast, const scene::Acting& acting, const Body& body);

}  // namespace weft::environment
