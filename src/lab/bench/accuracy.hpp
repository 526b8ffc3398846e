// Measures error and CPU time of runs of a scene, and how both depend on integrator, step, tolerances and mesh.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "film/run_error/trajectory.hpp"
#include "film/scene/scene.hpp"
#include "lab/bench/accuracy_plan.hpp"

namespace weft::bench {

using run_error::Errors, run_error::Functionals, run_error::Quantity, run_error::Trajectory, run_error::Work;
using run_error::kQuantities;

inline constexpr scene::Integrator kIntegrators[] = {scene::Integrator::implicit_euler,
                                                     scene::Integrator::implicit_midpoint, scene::Integrator::bdf2};

/// The values that differ between runs. All other values are those of the scene.
struct Setting {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;                       ///< [s]
  std::optional<double> tolerance = {};  ///< time.tolerance [m]; if set, it replaces the fixed step
  double newton_tolerance = 0, linear_tolerance = 0;
  double refinement = 1;  ///< number of cells along each side, relative to the scene
};

/// The parameter that varies in a series of runs. Along a series, the error should fall.
enum class Axis {
  grid,       ///< fixed steps; for each, runs divide newton_tolerance by ten until Run::is_step_limited or 1e-8
  tolerance,  ///< time.tolerance varies, with the solver settings of the scene
  linear,     ///< solver.linear_tolerance varies, at the scene's step
  mesh,       ///< the number of cells varies; error: difference to the run with twice the cells along each side
};
inline constexpr std::size_t kAxes = 4;

/// Results of one setting, run from one or several starts: initial states that differ by micrometres (start_noise).
/// With contact, errors are those of the functionals' medians over the starts; without contact, those of the trajectory
/// from the first start.
struct Run {
  Axis axis = Axis::grid;
  Setting setting;
  std::string failure = {};  ///< why the run did not reach the end; empty if it did
  Errors errors{};           ///< difference to the reference; for Axis::mesh, to the run with twice the cells
  Errors spread{};           ///< largest difference of a start to the medians (without contact: to the first start)
  /// Only for Axis::grid, in deciding_quantity(); otherwise NaN. `change`: difference to the run with a tenth of this
  /// newton_tolerance. `solver_error`: difference to the successful run with the same step and the smallest
  /// newton_tolerance; NaN for that run itself.
  double change = std::numeric_limits<double>::quiet_NaN(), solver_error = change;
  /// Only for Axis::grid: whether the step, not the solver, determines the error. True if `change` is at most a tenth
  /// of the error of the run with a tenth of this newton_tolerance, or at most the uncertainty of that error. If the
  /// scene's newton_tolerance is 1e-8 or less, a run with ten times its value decides instead, in the same way.
  bool is_step_limited = false;
  /// Cost of the run from the first start; but the CPU time is the minimum over all starts. If
  /// there is only one start and its run takes less than 0.3 s of CPU time, it is run twice, and
  /// the smaller time counts.
  Work work = {};
  int particles = 0;
  std::vector<double> start_errors = {};  ///< error of each start alone, in deciding_quantity(); empty for Axis::mesh

  bool failed() const { return !failure.empty(); }
};

inline double error_of(const Run& run, Quantity quantity) {
  return at(run.errors, quantity);
}

/// Value of the parameter that varies along the axis of the run: step [s], time.tolerance [m], linear_tolerance, or
/// cell size relative to the scene.
double control_of(const Run& run);
/// Expected order of the error in control_of(run): for Axis::mesh a lower bound, for Axis::linear 0 (unknown).
double expected_order(const Run& run);

/// A run that may serve as the reference for errors.
struct Candidate {
  Setting setting;
  std::string failure = {};
  Errors step{};    ///< error due to the step, extrapolated from the difference to the run with twice the step
  Errors solver{};  ///< difference to a run with ten times the newton_tolerance, both at twice the step
  Errors spread{};  ///< see Run::spread
  /// See Functionals::energies_in_play [J].
  double energies_in_play = 0;

  /// Uncertainty of this run: root of the sum of squares of `step`, `solver` and `spread`.
  Errors uncertainty() const;
};

/// Check of the reference by the run of an integrator with the shortest fixed step that was measured. The check is made
/// only if Run::is_step_limited is true for this run and for a run with a longer step.
struct CrossCheck {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;      ///< [s]
  Errors difference{};  ///< difference to the reference
  /// Uncertainty of this run: its difference to the run with the next longer step and Run::is_step_limited,
  /// extrapolated with half of the order (with contact, with an order of 0.5), plus Run::spread.
  Errors uncertainty{};
};

/// All runs of a measurement, and the references to which their errors refer.
struct Accuracy {
  bool contact = false;         ///< whether surfaces can touch in the scene; see production::can_collide()
  int starts = 1;               ///< number of starts of each setting; see Run
  double cloth_size = 0;        ///< run_error::cloth_size() at the start [m]
  int frames = 0;               ///< number of frames after the start
  double duration = 0;          ///< [s]
  double largest_energy = 0;    ///< Functionals::energies_in_play of the reference [J]
  Candidate reference, second;  ///< `reference` is the one with the smaller uncertainty; `second` checks it
  Errors difference{};          ///< difference between `reference` and `second`; 0 if `second` failed
  /// Uncertainty of the reference: at least Candidate::uncertainty() of `reference`. It is also at
  /// least the difference between the reference and `second`, or any cross check, minus the
  /// uncertainty of that other run.
  Errors uncertainty{};
  std::vector<CrossCheck> cross_checks;
  Setting of_scene;       ///< settings of the scene; the step is shortened so that it divides a frame evenly
  std::vector<Run> runs;  ///< runs of one series (same axis and integrator) are consecutive, from coarse to fine

  /// Uncertainty of the error of `run`. For Axis::mesh, only Run::spread, because the error does not refer to the
  /// reference.
  double uncertainty_of(const Run& run, Quantity quantity) const {
    return (run.axis == Axis::mesh ? 0 : at(uncertainty, quantity)) + at(run.spread, quantity);
  }
  /// Whether the error of `run` is larger than three times its uncertainty.
  bool resolved(const Run& run, Quantity quantity) const {
    return error_of(run, quantity) > 3 * uncertainty_of(run, quantity);
  }
  /// The runs of one series; for Axis::grid, those of all steps.
  std::vector<const Run*> series(Axis axis, scene::Integrator integrator) const;
  /// The successful run with the scene's own settings; nullptr if there is none.
  const Run* scene_setting_run() const;
  /// The runs of Axis::grid and of this integrator with Run::is_step_limited: at most one for each step.
  std::vector<const Run*> step_limited_runs(scene::Integrator integrator) const;
};

/// The quantities to report. Without contact: position, velocity and some functionals; with contact: only functionals.
std::vector<Quantity> quantities_of(const Accuracy& accuracy);
/// The quantity by which settings are compared: position, or with contact the centre of mass.
Quantity deciding_quantity(const Accuracy& accuracy);

/// The scene that is measured if the user names none, as TOML.
extern const char* const kSwingingSheet;

/// Called after the runs of each setting, also of those for the references. `done`: estimated fraction of the work that
/// is complete.
using EachRun = std::function<void(const Run& run, double done)>;

/// Raises `uncertainty` to at least CrossCheck::difference − CrossCheck::uncertainty of each cross check.
void raise_uncertainty(Errors& uncertainty, const std::vector<CrossCheck>& cross_checks);

/// Runs the scene some hundred times. Computes two independent references: with midpoint and BDF2; with contact, with
/// BDF2 and Euler, because midpoint does not damp contact. Their step is an eighth (with contact, half) of the shortest
/// step of Axis::grid. Of the two, the one with the smaller uncertainty in deciding_quantity() becomes the reference.
///
/// The newton_tolerance of a reference is chosen at twice its step. It is divided by ten until a division changes the
/// result by at most a tenth of the change expected from halving the step, or by at most the spread over the starts.
/// Division also ends at 1e-8, or if a run fails.
///
/// Throws Error(simulation_failed) if both references fail, and Error(usage) if the plan does not suit the scene.
Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each = {}, const AccuracyPlan& plan = {});

}  // namespace weft::bench
