// Members and functions of accuracy.hpp that evaluate runs.
#include <algorithm>
#include <cmath>

#include "lab/bench/accuracy.hpp"

namespace weft::bench {

using scene::Integrator;

Errors Candidate::uncertainty() const {
  Errors result{};
  for (std::size_t q = 0; q < kQuantities; ++q) result[q] = std::hypot(step[q], solver[q], spread[q]);
  return result;
}

double control_of(const Run& run) {
  switch (run.axis) {
    case Axis::grid:
      return run.setting.step;
    case Axis::tolerance:
      return run.setting.tolerance.value_or(0);
    case Axis::linear:
      return run.setting.linear_tolerance;
    case Axis::mesh:
      return 1 / run.setting.refinement;
  }
  return 0;
}

double expected_order(const Run& run) {
  const double order = run.setting.integrator == Integrator::implicit_euler ? 1 : 2;
  switch (run.axis) {
    case Axis::grid:
      return order;
    case Axis::tolerance:
      return order / (order + 1);
    case Axis::mesh:
      return 1;
    case Axis::linear:
      return 0;
  }
  return 0;
}

std::vector<Quantity> quantities_of(const Accuracy& accuracy) {
  if (!accuracy.contact)
    return {Quantity::position, Quantity::velocity, Quantity::energy, Quantity::drift, Quantity::centre};
  return {Quantity::centre, Quantity::energy, Quantity::drift, Quantity::shadow, Quantity::top, Quantity::rest_energy};
}

Quantity deciding_quantity(const Accuracy& accuracy) {
  return quantities_of(accuracy).front();
}

std::vector<const Run*> Accuracy::series(Axis axis, Integrator integrator) const {
  std::vector<const Run*> found;
  for (const Run& run : runs)
    if (run.axis == axis && run.setting.integrator == integrator) found.push_back(&run);
  return found;
}

std::vector<const Run*> Accuracy::step_limited_runs(Integrator integrator) const {
  std::vector<const Run*> found;
  for (const Run* run : series(Axis::grid, integrator))
    if (run->is_step_limited) found.push_back(run);
  return found;
}

const Run* Accuracy::scene_setting_run() const {
  const auto same = [&](const Run& run) {
    if (run.failed() || run.setting.integrator != of_scene.integrator) return false;
    if (of_scene.tolerance) return run.axis == Axis::tolerance && run.setting.tolerance == of_scene.tolerance;
    return run.axis == Axis::grid && run.setting.step == of_scene.step &&
           run.setting.newton_tolerance == of_scene.newton_tolerance;
  };
  const auto found = std::ranges::find_if(runs, same);
  return found == runs.end() ? nullptr : &*found;
}

void raise_uncertainty(Errors& uncertainty, const std::vector<CrossCheck>& cross_checks) {
  for (const CrossCheck& check : cross_checks)
    for (std::size_t q = 0; q < kQuantities; ++q)
      uncertainty[q] = std::max(uncertainty[q], check.difference[q] - check.uncertainty[q]);
}

}  // namespace weft::bench
