#include "physics/simulation/step_work.hpp"

#include "core/parallel.hpp"

namespace weft::simulation {

StepWork measure_work(const integrator::Stepper& stepper, std::span<const integrator::HeldParticle> pinned,
                      std::span<const double> masses, const integrator::State& start, const integrator::State& end) {
  // Work of the residual of the equation of motion on particle i. On a held particle, the residual is the force of the
  // constraint; on a free particle, the solver's error.
  const auto missing_work = [&](std::size_t i) {
    return stepper.constraint_force(static_cast<Index>(i), masses[i]).dot(end.x[i] - start.x[i]);
  };
  StepWork work;
  work.solver = parallel_sum(masses.size(), kGrainSize, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += missing_work(i);
    return sum;
  });
  for (const integrator::HeldParticle& held : pinned) {
    const auto i = static_cast<std::size_t>(held.constraint.particle);
    work.solver -= missing_work(i);
    // A held particle has the velocity of its pin, not the one that the method computes. Therefore the change of its
    // kinetic energy is computed from its velocities, and constraint_force() gets a mass of 0.
    work.pins += stepper.constraint_force(held.constraint.particle, 0).dot(end.x[i] - start.x[i]) +
                 0.5 * masses[i] * (end.v[i].squaredNorm() - start.v[i].squaredNorm());
  }
  return work;
}

}  // namespace weft::simulation
