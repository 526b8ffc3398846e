// Which particles of a cloth its pins and weights take, and which share of each.
#pragma once

#include <string>

#include "assets/mesh_file.hpp"
#include "environment/environment.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// Fills `pins`, `weights` and `attachments` of a cloth whose shape at rest is made. `file`: what the file of a mesh
/// says of its vertices; of other cloth it is empty. Throws Error(scene_invalid) after `where` for parts that hold no
/// particle, and for what the cloth has not: an edge, UVs, colours, a group.
void choose_particles(const scene::Scene& scene, const scene::Cloth& cloth, const assets::LoadedMesh& file,
                      const std::string& where, ClothObject& object);

}  // namespace weft::environment
