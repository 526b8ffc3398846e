// Moves sheets that hang from a body (their carrier), such as capes, off this body at the start.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/environment/wearers.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// The name of the carrier of a cloth: the character that the first pin of the cloth with a
/// `follow` like "model.torso" (a part of a character with bones) names. Empty if there is no such
/// pin.
std::string carrier_of(const scene::Scene& scene, const scene::Cloth& cloth);

/// If skin of the carrier reaches through a rectangular cloth, moves the whole cloth along its
/// normal, away from the middle of the body. Afterwards, all skin opposite the rectangle is on one
/// side, at least the contact thickness away. Untangling cannot do this, since pins hold particles
/// at their start positions. `start`: start positions of the particles. Returns the distance [m]; 0
/// if nothing moved.
double move_off_carrier(const scene::Cloth& cloth, const garment::Wearer& carrier, std::span<Vec3> start);

}  // namespace weft::environment
