// Stepper::split_impacts(): the part of a BDF2 step that impacts cause.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics.hpp"
#include "core/timer.hpp"
#include "physics/integrator/stepper.hpp"

namespace weft::integrator {

// Replaces the velocity changes δ/β of impacts by δ/h; see Stepper. Adds the iterations of the linear solve to
// `report`. If the matrix is indefinite, rejects the step: the velocities would lack a part of the impacts. If the
// iterations run out, includes the error of the velocities in StepReport::solver_error.
void Stepper::split_impacts(System& system, const State& now, double h, StepReport& report) {
  std::vector<Vec3>& right_side = scratch_;
  std::ranges::fill(right_side, Vec3::Zero());
  const StepStart start{h, now.x, now.v, history_.h, history_.before.x, history_.before.v};
  {
    const Stopwatch watch(times_.forces);
    if (!system.find_impacts(stage_point(), start, right_side)) return;
  }
  cg_.filter(right_side);
  {
    const Stopwatch watch(times_.preconditioner);
    cg_.prepare(system.linear_system(), solver::AggregateSums::reuse);
  }
  goals_.clear();
  for (const BlockState& block : blocks_)
    goals_.push_back(numerics.newton.linear_fraction * block.allowed * std::sqrt(block.mass) / stage_.beta);
  impact_changes_.resize(x_.size());
  const Stopwatch watch(times_.linear);
  const solver::LinearReport solved = cg_.solve(right_side, {parameters_.linear_tolerance, goals_},
                                                parameters_.max_linear_iterations, impact_changes_, {.motion = v_});
  report.linear_iterations += solved.iterations;
  if (!solved.definite) report.verdict = Verdict::indefinite;
  if (solved.converged) return;
  for (std::size_t p = 0; p < blocks_.size(); ++p) {
    const double error = std::abs(stage_.beta - h) * solved.errors[p] / std::sqrt(blocks_[p].mass);  // [m/s]
    report.solver_error = std::max(report.solver_error, error * numerics.newton.error_duration);
  }
}

}  // namespace weft::integrator
