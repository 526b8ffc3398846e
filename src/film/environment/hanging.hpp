// Moves sheets that hang from a body, such as capes, off the body at the start.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/environment/wearers.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// The name of the character by whose part a pin of this cloth is held, as in follow = "model.torso"; empty if there is
/// none.
std::string carrier_of(const scene::Scene& scene, const scene::Cloth& cloth);

/// If skin of its carrier reaches through the plane of an untangled rectangle of cloth, moves the cloth as a whole
/// along its normal, away from the middle of the body, until all of that skin is on one side: pins hold particles where
/// they start, so untangling cannot move those. Returns the distance [m]; 0 if nothing moved.
double move_off_carrier(const scene::Cloth& cloth, const garment::Wearer& carrier, std::span<Vec3> start);

}  // namespace weft::environment
