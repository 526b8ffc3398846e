// Finds the parts of a character: those that the scene lists, those that pins, obstacles or cameras follow, and hands.
#pragma once

#include <span>
#include <vector>

#include "film/environment/actor.hpp"
#include "film/environment/character_context.hpp"

namespace weft::environment {

/// Finds the vertices of each part. If the body collides, its hands have fingers, and no [[character.part]] by name
/// includes a hand, adds a part of hands that do not collide, and a warning to `body`. Throws Error(scene_invalid) for
/// a part that contains no triangle, and for a name that is no part, joint, bone or material of the body.
std::vector<Part> parts_of(const CharacterContext& context, std::span<const FollowerPoints> following, Body& body);

/// Numbers the shells of a body: vertices get the same number if they are in the same connected component of the mesh
/// and in the same character::Limb. Contact treats each shell as a limb of its own (model::Body::limbs). Shells of one
/// body, such as a pouch and a belt, may then overlap: faces of the pouch inside the belt do not affect where the
/// outside of the belt is.
std::vector<Index> shells_of_limbs(const Body& body);

}  // namespace weft::environment
