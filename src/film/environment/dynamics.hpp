// Rigid-body properties of an obstacle that forces move.
#pragma once

#include <memory>

#include "film/scene/scene.hpp"
#include "physics/mesh/mesh.hpp"
#include "physics/model/model.hpp"

namespace weft::environment {

/// Makes the mass, inertia, start velocities and release time of an obstacle with a mass or a
/// density. `mesh`: of the obstacle. Throws Error(scene_invalid) if the mesh has a border or
/// encloses no volume.
std::shared_ptr<const model::Dynamics> make_dynamics(const scene::Scene& scene, const scene::Obstacle& obstacle,
                                                     const mesh::Mesh& mesh);

}  // namespace weft::environment
