// Tells energy that comes from nowhere: a method of integration that runs away stays finite for long.
#pragma once

#include <optional>
#include <string>

#include "core/archive.hpp"
#include "environment/environment.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace weft::simulation {

/// Where nothing drives a scene (no moving pin or body, no wind), its mechanical energy can only fall, but for what
/// steps solved to a tolerance add. A run that gains more is warned of, and one that gains much more ends, but where
/// cloth can touch something and the method damps: contacts at long steps may bring energy, which goes again.
class EnergyBound {
 public:
  EnergyBound(const scene::Scene& scene, const FrameReport& start);

  /// Of a frame whose energies are more than there can be: throws Error(simulation_failed), or returns a warning, once
  /// in a run.
  std::optional<std::string> check(int frame, const FrameReport& energies);

  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, potential_low_, potential_high_, warned_);
  }

 private:
  bool applies_, damped_contact_;
  bool warned_ = false;
  scene::Integrator integrator_;
  double start_;                           // mechanical energy [J]
  double moving_, elastic_;                // kinetic and elastic energy of the start [J]
  double potential_low_, potential_high_;  // so far [J]
};

}  // namespace weft::simulation
