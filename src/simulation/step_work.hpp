// Work that one step does on the cloth: that of pins, and that of what the solver leaves of the equation of motion.
#pragma once

#include <span>

#include "integrator/stepper.hpp"

namespace weft::simulation {

/// [J]
struct StepWork {
  double pins = 0;    ///< that held particles bring in, their own kinetic energy included
  double solver = 0;  ///< of the forces by which the equation of motion is not met; 0 if it is solved exactly
};

/// Work of the step from `start` to `end` that the stepper has computed last. `pinned`: particles that the scene holds.
/// Forces are those of the stage, so that the work is exact to the order of the method.
StepWork measure_work(const integrator::Stepper& stepper, std::span<const integrator::HeldParticle> pinned,
                      std::span<const double> masses, const integrator::State& start, const integrator::State& end);

}  // namespace weft::simulation
