// Properties of an obstacle that forces move.
#pragma once

#include <memory>

#include "core/types.hpp"
#include "mesh/mesh.hpp"
#include "mesh/rigid_frame.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

struct Dynamics {
  mesh::RigidFrame frame;
  double mass = 0;                 ///< [kg]
  Vec3 velocity{0, 0, 0};          ///< at the start [m/s]
  Vec3 angular_velocity{0, 0, 0};  ///< at the start [rad/s]
  double release = 0;  ///< from this time on, forces move it instead of its keys [s]; minus infinity: always
};

/// Makes the properties of an obstacle with a mass or a density. `mesh`: its mesh. Throws Error(scene_invalid) if the
/// mesh encloses no volume.
std::shared_ptr<const Dynamics> make_dynamics(const scene::Scene& scene, const scene::Obstacle& obstacle,
                                              const mesh::Mesh& mesh);

}  // namespace weft::environment
