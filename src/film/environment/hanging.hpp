// Moves sheets that hang from a body (their carrier), such as capes, off this body at the start.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/environment/wearers.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// The name of the carrier of a cloth: of the character whose part the first suitable pin of the cloth follows. A pin
/// is suitable if its `follow` names a part of a character with bones, such as "model.torso". Empty if there is none.
std::string carrier_of(const scene::Scene& scene, const scene::Cloth& cloth);

/// If skin of the carrier reaches through a rectangular cloth, moves the whole cloth along its normal, away from the
/// middle of the body. Afterwards, all skin whose projection along the normal lies in the rectangle is on one side of
/// it, at least the contact thickness away. Untangling cannot do this, because pins hold particles at their start
/// positions. `start`: start positions of the particles [m]. Returns the distance by which the cloth moved [m]; 0 if it
/// did not.
double move_off_carrier(const scene::Cloth& cloth, const garment::Wearer& carrier, std::span<Vec3> start);

}  // namespace weft::environment
