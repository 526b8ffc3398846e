// A rope as it starts.
#pragma once

#include "environment/environment.hpp"

namespace weft::environment {

/// Fills in where the particles of a rope are and how they are joined. A piece is a triangle whose last two corners are
/// one: all that takes triangles takes it for an edge.
void use_rope(const scene::Scene& scene, const scene::Rope& rope, ClothObject& object);

}  // namespace weft::environment
