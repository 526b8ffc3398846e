// Finds the parts of a character: those that the scene lists, those that pins, obstacles or cameras follow, and hands.
#pragma once

#include <span>
#include <vector>

#include "film/environment/acting.hpp"
#include "film/environment/cast.hpp"

namespace weft::environment {

/// Finds the vertices of each part. If the body collides, hands have fingers, and no [[character.part]] by name
/// includes a hand, the hands do not collide; adds a warning to `body` then. Throws Error(scene_invalid) for a part
/// that holds no triangle, and for a name that is no part, joint, bone or material of the body.
std::vector<Part> parts_of(const Cast& cast, const scene::SkeletonMotion& acting,
                           std::span<const FollowerPoints> following, Body& body);

/// Numbers the shells of a body: vertices get the same number if they are in one connected component and one
/// character::Limb. Contact treats each shell as a limb of its own (model::Body::limbs). Shells of one body may
/// overlap, such as a pouch and a belt: faces of the pouch inside the belt then do not determine where the outside of
/// the belt is.
std::vector<Index> shells_of_limbs(const Cast& cast, const scene::SkeletonMotion& acting, const Body& body);

}  // namespace weft::environment
