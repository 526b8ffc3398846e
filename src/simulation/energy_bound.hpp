// Tells energy that comes from nowhere: a method of integration that runs away stays finite for long.
#pragma once

#include "core/archive.hpp"
#include "environment/environment.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace weft::simulation {

/// Where nothing drives a scene (no moving pin or body, no wind), its mechanical energy can only fall, but for what
/// steps solved to a tolerance add. Contacts at long steps may bring some, and where a method damps it goes again: of
/// scenes in which cloth can touch something only those of the midpoint rule are held to it.
class EnergyBound {
 public:
  EnergyBound(const scene::Scene& scene, const FrameReport& start);

  /// Throws Error(simulation_failed) where the energies of this frame are more than there can be.
  void check(int frame, const FrameReport& energies);

  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, potential_low_, potential_high_);
  }

 private:
  bool applies_;
  scene::Integrator integrator_;
  double start_;                           // mechanical energy [J]
  double moving_, elastic_;                // kinetic and elastic energy of the start [J]
  double potential_low_, potential_high_;  // so far [J]
};

}  // namespace weft::simulation
