// Finds energy that nothing brings in: a method of integration that runs away stays finite for long; and motion that
// the solver has left unsolved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/archive.hpp"
#include "environment/environment.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace weft::simulation {

/// If nothing but pins drives a scene (no moving body, no wind), its mechanical energy grows by no more than the work
/// of the pins and what steps solved to a tolerance add. A run that gains more is warned of, and one that gains much
/// more ends; if cloth can touch something and the method damps, it is only warned of: contacts at long steps may bring
/// energy, which goes again. Of every scene a run is warned of in which the solver's remainder has done much of the
/// work: its motion is finite and may be far off.
class EnergyBound {
 public:
  /// `mass`: of all cloths [kg].
  EnergyBound(const scene::Scene& scene, double mass, const FrameReport& start);

  /// Of a frame whose energies are more than there can be: throws Error(simulation_failed), or returns warnings, each
  /// once in a run.
  std::vector<std::string> check(const FrameReport& energies);

  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, potential_low_, potential_high_, pin_work_, pin_work_low_, pin_work_high_, solver_work_,
                     highest_, has_lagged_, warned_, warned_of_solver_);
  }

 private:
  double energy_in_play() const;
  std::optional<std::string> check_gain(const FrameReport& energies);
  std::optional<std::string> check_solver(int frame);

  bool applies_, damped_contact_;
  bool has_lagged_ = false;  // a pin: what draws it does work that is not counted
  bool warned_ = false, warned_of_solver_ = false;
  scene::Integrator integrator_;
  double small_;                                                // energy that is too small to be taken for an error [J]
  double start_;                                                // mechanical energy [J]
  double moving_, elastic_;                                     // kinetic and elastic energy of the start [J]
  double potential_low_, potential_high_;                       // so far [J]
  double pin_work_ = 0, pin_work_low_ = 0, pin_work_high_ = 0;  // likewise, since the start [J]
  double solver_work_ = 0;                                      // likewise, without its sign in each frame [J]
  double highest_ = 0;                                          // kinetic and elastic energy so far [J]
};

}  // namespace weft::simulation
