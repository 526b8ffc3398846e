// Makes a rope of a scene, as it is at the start of the run.
#pragma once

#include "film/environment/made_cloth.hpp"

namespace weft::environment {

/// Fills `made` with the particles of a rope and its pieces, the straight segments between particles. A piece is stored
/// as a triangle whose last two corners are equal, so that code for triangles treats it as an edge.
void fill_from_rope(const scene::Scene& scene, const scene::Rope& rope, MadeCloth& made);

}  // namespace weft::environment
