// Finds the parts of a character: those that the scene lists, those that pins, obstacles or cameras follow, and hands.
#pragma once

#include <span>
#include <vector>

#include "film/environment/acting.hpp"
#include "film/environment/cast.hpp"

namespace weft::environment {

/// Finds the vertices of each part. If hands do not collide by default, adds a warning to `body`. Throws
/// Error(scene_invalid) for a part that holds no triangle, and for a name that is no part, joint, bone or material of
/// the body.
std::vector<Part> parts_of(const Cast& cast, const scene::SkeletonMotion& acting,
                           std::span<const FollowerPoints> following, Body& body);

/// Numbers the shells of a body: vertices get the same number if they are in one connected component and one
/// character::Limb. Contact treats each shell as a limb of its own (model::Body::limbs). If shells overlap, such as a
/// pouch and a belt, faces of one that lie inside the other then do not determine where the outside of the other is.
std::vector<Index> shells_of_limbs(const Cast& cast, const scene::SkeletonMotion& acting, const Body& body);

}  // namespace weft::environment
