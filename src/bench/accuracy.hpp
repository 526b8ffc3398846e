// Error against run time: what each integrator, step, tolerance, solver setting and mesh costs and buys on a scene.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy_plan.hpp"
#include "bench/trajectory.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

inline constexpr scene::Integrator kIntegrators[] = {scene::Integrator::implicit_euler,
                                                     scene::Integrator::implicit_midpoint, scene::Integrator::bdf2};

/// What is varied from run to run; the rest is the scene's.
struct Setting {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;                       ///< [s]
  std::optional<double> tolerance = {};  ///< instead of the step [m]
  double newton_tolerance = 0, linear_tolerance = 0;
  double refinement = 1;  ///< cells along each side, times those of the scene
};

/// Runs that differ in one thing, along which the error is expected to fall.
enum class Axis {
  grid,       ///< fixed steps, each with solver.newton_tolerance tenfold smaller from run to run
  tolerance,  ///< time.tolerance, solver settings of the scene
  linear,     ///< solver.linear_tolerance, at the scene's step
  mesh,       ///< error against the mesh with twice the cells along each side
};
inline constexpr std::size_t kAxes = 4;

struct Run {
  Axis axis = Axis::grid;
  Setting setting;
  std::string failure = {};  ///< why it did not reach the end; empty where it did
  Errors errors{};           ///< with contact of the median over the starts
  Errors spread{};           ///< how far one start is from the median; 0 where there is one start alone
  /// Of the grid, in the deciding quantity: what newton_tolerance a tenth as large changes; how far the run is from the
  /// most exactly solved one with its step. Not known (NaN) elsewhere.
  double change = std::numeric_limits<double>::quiet_NaN(), left = change;
  /// Of the grid: `change` is below a tenth of the error, or below what is known of it, so that the step decides.
  bool step_decides = false;
  Work work = {};  ///< the least CPU time of two runs or of the starts
  int particles = 0;
  std::vector<double> start_errors = {};  ///< of each start by itself, in the deciding quantity

  bool failed() const { return !failure.empty(); }
};

inline double error_of(const Run& run, Quantity quantity) {
  return at(run.errors, quantity);
}

/// What the error of a run depends on: its step, tolerance or spacing.
double control_of(const Run& run);
/// Exponent with which the error should follow it; of meshes the least that is expected.
double expected_order(const Run& run);

/// A run that errors could be measured against.
struct Candidate {
  Setting setting;
  std::string failure = {};
  Errors step{};    ///< its own, from the difference to twice its step and half of its order
  Errors solver{};  ///< what newton_tolerance a tenth as large changes at twice its step
  Errors spread{};  ///< how far one start is from the median
  double energies_in_play = 0;

  /// The root of the sum of their squares.
  Errors doubt() const;
};

/// The finest run of an integrator in which the step decides: it bounds how far off the reference can be.
struct CrossCheck {
  Setting setting;
  Errors apart{};  ///< from the reference
  Errors doubt{};  ///< how far it may be off itself: by half of its order from the next longer step, and by its starts
};

struct Accuracy {
  bool contact = false;         ///< whether anything can touch anything in the scene
  int starts = 1;               ///< of each setting
  double cloth_size = 0;        ///< longest side of the box around the largest cloth at the start [m]
  int frames = 0;               ///< after the start
  double duration = 0;          ///< [s]
  double largest_energy = 0;    ///< the energies in play [J]
  Candidate reference, second;  ///< the better known one, and the one that it is checked against
  Errors apart{};               ///< how far these two are apart; 0 where the second failed
  Errors uncertainty{};         ///< of the reference: its doubt, and what the second and the cross checks add
  std::vector<CrossCheck> cross_checks;
  Setting of_scene;       ///< as the scene stands, its step such that frames are cut evenly
  std::vector<Run> runs;  ///< by axis and integrator, each series from coarse to fine

  /// What an error may be wrong by.
  double doubt(const Run& run, Quantity quantity) const {
    return (run.axis == Axis::mesh ? 0 : at(uncertainty, quantity)) + at(run.spread, quantity);
  }
  /// Whether an error is known to a third.
  bool resolved(const Run& run, Quantity quantity) const { return error_of(run, quantity) > 3 * doubt(run, quantity); }
  /// The runs of one series; of the grid those of all steps.
  std::vector<const Run*> series(Axis axis, scene::Integrator integrator) const;
  /// With the settings of the scene; null where it was not measured.
  const Run* as_it_stands() const;
  /// Of the grid: for each step the first run in which it decides.
  std::vector<const Run*> decided(scene::Integrator integrator) const;
};

/// What is told of the scene: without contact paths, with it functionals.
std::vector<Quantity> quantities_of(const Accuracy& accuracy);
/// What the scene is judged by: positions, with contact the centre of mass.
Quantity deciding_quantity(const Accuracy& accuracy);

/// A scene to measure where none is given, as TOML.
extern const char* const kSwingingSheet;

/// Told after each run, with the share of the work that is done.
using EachRun = std::function<void(const Run& run, double done)>;

/// Raises the uncertainty of a reference to what the own doubts of its cross checks do not explain.
void raise_uncertainty(Errors& uncertainty, const std::vector<CrossCheck>& cross_checks);

/// Runs the scene some hundred times; with contact from several starts that differ by micrometres, of which the median
/// counts. Two references are made independently: midpoint (with contact, which it does not damp, BDF2) and BDF2 (with
/// contact Euler), with steps an eighth (with contact a half) of the finest measured and solved so exactly that a
/// tenfold smaller newton_tolerance changes less than a tenth of what the step does. The better known one is taken,
/// and held against the finest runs of each integrator. Throws Error(simulation_failed) where both fail, and
/// Error(usage) where the plan does not suit the scene.
Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each = {}, const AccuracyPlan& plan = {});

}  // namespace weft::bench
