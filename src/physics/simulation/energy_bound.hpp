// Detects a growth of energy without a source: an unstable run may stay finite for long. Also
// detects large work of the solver's residual.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/archive.hpp"
#include "physics/model/model.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::simulation {

/// If nothing but pins drives a model (for example, no body moves and no wind blows), its
/// mechanical energy exceeds that of the start at most by the work of the pins and by errors of the
/// solver. If the excess is larger than `numerics.energy.doubtful_gain` times the energy in play
/// (Numerics::Energy), the run warns; if it is larger than `failing_gain` times this energy, the
/// run fails. If cloth can touch something and the method damps, the run only warns: contacts at
/// long steps can add energy, which the method then damps. Any run warns if the work of the
/// solver's residual is large: the motion stays finite but may be far from the exact one.
class EnergyBound {
 public:
  /// `mass`: of all particles [kg].
  EnergyBound(const model::Model& model, double mass, const FrameReport& start);

  /// Checks a frame. Returns warnings, each once in a run. Throws Error(simulation_failed) if the gain exceeds
  /// `failing_gain`, unless the run only warns (see above).
  std::vector<std::string> check(const FrameReport& energies);

  /// Ends the checks of gains. Call this when something other than pins begins to drive the model.
  void exempt_gains() { is_exempt_ = true; }

  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, potential_low_, potential_high_, pin_work_, pin_work_low_, pin_work_high_, solver_work_,
                     highest_, is_exempt_, warned_, warned_of_solver_);
  }

 private:
  double energy_in_play() const;  // as in Numerics::Energy [J]
  std::optional<std::string> check_gain(const FrameReport& energies);
  std::optional<std::string> check_solver(int frame);

  bool applies_, damped_contact_;  // whether pins alone drive the model; whether the run only warns of a large gain
  // Whether gains are not checked any more: exempt_gains() was called, or pinned particles have lagged. (The work of
  // the force that pulls lagging particles is not measured.)
  bool is_exempt_ = false;
  bool warned_ = false, warned_of_solver_ = false;
  integrator::Method integrator_;
  double negligible_energy_;               // added to each bound: mass times Numerics::Energy::negligible [J]
  double start_energy_;                    // mechanical energy at the start [J]
  double start_kinetic_, start_elastic_;   // at the start [J]
  double potential_low_, potential_high_;  // lowest and highest energy of gravity and enclosed air so far [J]
  // Work of pins since the start, with its lowest and highest value [J].
  double pin_work_ = 0, pin_work_low_ = 0, pin_work_high_ = 0;
  double solver_work_ = 0;  // sum over frames of |work of the solver's residual| [J]
  double highest_ = 0;      // largest sum of kinetic and elastic energy so far [J]
};

}  // namespace weft::simulation
