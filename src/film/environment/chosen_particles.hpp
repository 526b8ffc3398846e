// Finds the particles that belong to the pins, weights and attachments of a cloth, and how much each particle belongs
// to them: a fraction from 0 to 1.
#pragma once

#include <string>
#include <vector>

#include "film/assets/mesh_file.hpp"
#include "film/environment/made_cloth.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// Adds pins (without their motion), weights and attachments to `made`, which must already have its rest shape. `file`:
/// the data of the mesh file; empty for cloth without one. Throws Error(scene_invalid) for a region that contains no
/// particle, and for a panel, an edge, UVs, colours or a group that the cloth does not have. The message begins with
/// `where` or, for attachments, with the scene file and their name. Throws Error(asset_unreadable) for a mask that
/// cannot be read.
void choose_particles(const scene::Scene& scene, const scene::Cloth& cloth, const assets::LoadedMesh& file,
                      const std::string& where, MadeCloth& made);

/// Throws Error(scene_invalid) for a name that is not among the known ones, with the most similar of these. `key`,
/// `field`: key of a table in the scene, and the key in it; `kind`: what is expected.
[[noreturn]] void refuse_name(const std::string& name, const std::vector<std::string>& known, const std::string& key,
                              const char* field, const char* kind);

}  // namespace weft::environment
