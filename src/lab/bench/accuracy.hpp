// Measures error against run time: how integrator, step, tolerance, solver settings and mesh affect both on a scene.
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

/// The values that differ between runs; everything else is the scene's.
struct Setting {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;                       ///< [s]
  std::optional<double> tolerance = {};  ///< if set, time.tolerance [m], which replaces the fixed step
  double newton_tolerance = 0, linear_tolerance = 0;
  double refinement = 1;  ///< number of cells along each side, relative to the scene
};

/// The parameter that varies within a series of runs; the error is expected to fall along it.
enum class Axis {
  grid,       ///< fixed steps; for each, solver.newton_tolerance falls tenfold from run to run until the step decides
  tolerance,  ///< time.tolerance varies, with the solver settings of the scene
  linear,     ///< solver.linear_tolerance varies, at the scene's step
  mesh,       ///< cells vary; the error is the difference to the mesh with twice the cells along each side
};
inline constexpr std::size_t kAxes = 4;

struct Run {
  Axis axis = Axis::grid;
  Setting setting;
  std::string failure = {};  ///< why the run did not reach the end; empty if it did
  Errors errors{};           ///< difference to the reference, or for Axis::mesh to the finer mesh
  Errors spread{};           ///< largest difference of a start to the median (without contact: to the first start)
  /// Only for Axis::grid, in the deciding quantity; otherwise NaN. `change`: difference to the run with a tenth of this
  /// newton_tolerance. `left`: difference to the most exactly solved run with the same step.
  double change = std::numeric_limits<double>::quiet_NaN(), left = change;
  /// Only for Axis::grid: whether the step, not the solver, determines the error ("the step decides"). This holds if
  /// `change` is at most a tenth of the error of the run with a tenth of this newton_tolerance, or at most the
  /// uncertainty of that error.
  bool step_decides = false;
  Work work = {};  ///< of the first start; CPU time: minimum over all starts, or over two runs of a short single start
  int particles = 0;
  std::vector<double> start_errors = {};  ///< error of each start alone, in the deciding quantity; empty for Axis::mesh

  bool failed() const { return !failure.empty(); }
};

inline double error_of(const Run& run, Quantity quantity) {
  return at(run.errors, quantity);
}

/// Value of the parameter that varies along the axis of the run: step [s], time.tolerance [m], linear_tolerance, or
/// cell size relative to the scene.
double control_of(const Run& run);
/// Expected order of the error in control_of(run); for meshes a lower bound, for Axis::linear 0 (unknown).
double expected_order(const Run& run);

/// A run that may serve as the reference for errors.
struct Candidate {
  Setting setting;
  std::string failure = {};
  Errors step{};    ///< error due to its step, extrapolated from the difference to the run with twice the step
  Errors solver{};  ///< change that a tenfold newton_tolerance causes, measured at twice the step
  Errors spread{};  ///< as Run::spread
  /// As Functionals::energies_in_play [J].
  double energies_in_play = 0;

  /// Uncertainty of this run: root of the sum of squares of the three errors above.
  Errors doubt() const;
};

/// Check of the reference by the run of an integrator with the shortest measured step. The check is made only if the
/// step decides in that run and in a run with a longer step.
struct CrossCheck {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;  ///< [s]
  Errors apart{};   ///< difference to the reference
  Errors doubt{};   ///< uncertainty of this run: difference to the next longer step in which the step decides,
                    ///< extrapolated with half of the order (with contact 0.5), plus the spread over the starts
};

struct Accuracy {
  bool contact = false;         ///< whether any two surfaces can touch in the scene
  int starts = 1;               ///< number of starts of each setting
  double cloth_size = 0;        ///< longest side of the box around the largest cloth at the start [m]
  int frames = 0;               ///< number of frames after the start
  double duration = 0;          ///< [s]
  double largest_energy = 0;    ///< energies in play of the reference [J]; see Functionals::energies_in_play
  Candidate reference, second;  ///< `reference` is the more certain one, `second` checks it
  Errors apart{};               ///< difference between these two; 0 if the second failed
  Errors uncertainty{};         ///< of the reference: its doubt(), raised if `second` or a cross check differs by more
  std::vector<CrossCheck> cross_checks;
  Setting of_scene;       ///< settings of the scene, with the step shortened so that it divides a frame evenly
  std::vector<Run> runs;  ///< each series (one axis and integrator) is contiguous and runs from coarse to fine

  /// Uncertainty of the error of `run`.
  double doubt(const Run& run, Quantity quantity) const {
    return (run.axis == Axis::mesh ? 0 : at(uncertainty, quantity)) + at(run.spread, quantity);
  }
  /// Whether the error of `run` exceeds three times its uncertainty.
  bool resolved(const Run& run, Quantity quantity) const { return error_of(run, quantity) > 3 * doubt(run, quantity); }
  /// The runs of one series; for Axis::grid those of all steps.
  std::vector<const Run*> series(Axis axis, scene::Integrator integrator) const;
  /// The run with the scene's own settings; nullptr if there is none.
  const Run* scene_setting_run() const;
  /// For Axis::grid: for each step the run in which the step decides, if there is one.
  std::vector<const Run*> decided(scene::Integrator integrator) const;
};

/// The reported quantities. Without contact: position, velocity and some functionals; with contact: only functionals.
std::vector<Quantity> quantities_of(const Accuracy& accuracy);
/// The quantity by which settings are compared: position, or with contact the centre of mass.
Quantity deciding_quantity(const Accuracy& accuracy);

/// The scene that is measured if the user names none, as TOML.
extern const char* const kSwingingSheet;

/// Called after each run; `done` is the fraction of the work that is complete.
using EachRun = std::function<void(const Run& run, double done)>;

/// Raises `uncertainty` to the part of each cross check's difference that its own uncertainty does not explain.
void raise_uncertainty(Errors& uncertainty, const std::vector<CrossCheck>& cross_checks);

/// Runs the scene some hundred times. With contact, each setting runs from several starts that differ by micrometres,
/// and their median counts. Two references are computed independently: with midpoint and BDF2, or with contact with
/// BDF2 and Euler, as midpoint does not damp contact. Their steps are an eighth (with contact half) of the shortest
/// measured step. Their newton_tolerance is lowered until, at twice their step, a tenfold decrease changes the result
/// by less than a tenth of the step error or less than the starts differ, or until it is 1e-8 or a run fails. The more
/// certain one becomes the reference, and is checked by the run of each integrator with the shortest step. Throws
/// Error(simulation_failed) if both references fail, and Error(usage) if the plan does not suit the scene.
Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each = {}, const AccuracyPlan& plan = {});

}  // namespace weft::bench
