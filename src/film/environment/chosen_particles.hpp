// Finds the particles of a cloth that belong to its pins, weights and attachments, and the fraction, 0 to 1, of each
// particle.
#pragma once

#include <string>

#include "film/assets/mesh_file.hpp"
#include "film/environment/made_cloth.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// Adds pins (without their motion), weights and attachments to a cloth whose rest shape is already
/// made. `file`: the data of the mesh file; empty for cloth without one. Throws
/// Error(scene_invalid) for a region that holds no particle, and for a panel, an edge, UVs, colours
/// or a group that the cloth does not have. The message begins with `where` or, for attachments,
/// with the scene file and their name. Throws Error(asset_unreadable) for a mask that cannot be
/// read.
void choose_particles(const scene::Scene& scene, const scene::Cloth& cloth, const assets::LoadedMesh& file,
                      const std::string& where, MadeCloth& made);

}  // namespace weft::environment
