// Work on the cloth in one step: by pins, and by the residual of the equation of motion.
#pragma once

#include <span>

#include "physics/integrator/stepper.hpp"

namespace weft::simulation {

/// Work in one step [J].
struct StepWork {
  double pins = 0;    ///< by pins and keys; includes the change of the kinetic energy of held particles
  double solver = 0;  ///< by the residual on other particles; 0 after an exact solve without velocity constraints
};

/// Work in the last step of the stepper, from `start` to `end`. `pinned`: particles that pins or keys hold. Uses the
/// forces of the stage (integrator::StagePoint), so the error of the work has the order of the
/// method.
StepWork measure_work(const integrator::Stepper& stepper, std::span<const integrator::HeldParticle> pinned,
                      std::span<const double> masses, const integrator::State& start, const integrator::State& end);

}  // namespace weft::simulation
