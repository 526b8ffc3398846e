// Error against run time: what each integrator, step, tolerance, solver setting and mesh costs and buys on a scene.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace weft::bench {

inline constexpr scene::Integrator kIntegrators[] = {scene::Integrator::implicit_euler,
                                                     scene::Integrator::implicit_midpoint, scene::Integrator::bdf2};

/// What an error is measured in. The first three compare whole motions: the largest value of all frames counts. The
/// others are single numbers of the last frame, which converge even where contact lets the paths of particles part.
enum class Quantity : std::size_t {
  position,     ///< root of the mean square over the mass [m]
  velocity,     ///< likewise [m/s]
  energy,       ///< kinetic, elastic and of height, in shares of the energies in play
  shadow,       ///< area that the cloths cover seen from above, each by itself, in shares of their area
  top,          ///< height of the highest particle [m]
  rest_energy,  ///< elastic and of height, in shares of the energies in play
  centre,       ///< of mass [m]
};
inline constexpr std::size_t kQuantities = 7;
std::string_view name_of(Quantity quantity);
std::string_view unit_of(Quantity quantity);

/// One error for each quantity.
using Errors = std::array<double, kQuantities>;

/// What is varied from run to run; the rest is the scene's.
struct Setting {
  scene::Integrator integrator = scene::Integrator::implicit_euler;
  double step = 0;                       ///< [s]
  std::optional<double> tolerance = {};  ///< instead of the step [m]
  double newton_tolerance = 0, linear_tolerance = 0;
  double refinement = 1;  ///< cells along each side, times those of the scene
  double noise = 0;       ///< added to start_noise [m]
};

/// Runs that differ in one thing, along which the error is expected to fall.
enum class Axis {
  step,        ///< fixed steps, Newton's method so exact that the step alone decides
  scene_step,  ///< fixed steps, solver settings of the scene
  tolerance,   ///< time.tolerance
  newton,      ///< solver.newton_tolerance, at the scene's step; error against the exactly solved run
  linear,      ///< solver.linear_tolerance, likewise
  mesh,        ///< error against the mesh with twice the cells along each side
};
inline constexpr std::size_t kAxes = 6;

struct Run {
  Axis axis = Axis::step;
  Setting setting;
  std::string failure = {};  ///< why it did not reach the end; empty where it did
  Errors errors{};
  double cpu_s = 0;  ///< of the frames; the least of two where it is short
  int particles = 0, steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;

  bool failed() const { return !failure.empty(); }
};

inline double error_of(const Run& run, Quantity quantity) {
  return run.errors[static_cast<std::size_t>(quantity)];
}

/// What the error of a run depends on: its step, tolerance or spacing.
double control_of(const Run& run);
/// Exponent with which the error should follow it; of meshes the least that is expected.
double expected_order(const Run& run);

struct Accuracy {
  bool contact = false;  ///< whether anything can touch anything in the scene
  Setting reference;
  int frames = 0;             ///< after the start
  double duration = 0;        ///< [s]
  Errors uncertainty{};       ///< of the reference: see measure_accuracy(); infinite where it is not known
  double largest_energy = 0;  ///< the energies in play [J]: most kinetic and elastic energy, and largest fall
  std::vector<Run> runs;      ///< by axis and integrator, each series from coarse to fine

  /// Whether an error is more than ten times what the reference is uncertain by.
  bool resolved(const Run& run, Quantity quantity) const {
    const auto q = static_cast<std::size_t>(quantity);
    return run.axis >= Axis::newton || run.errors[q] > 10 * uncertainty[q];
  }
  /// The runs of one series.
  std::vector<const Run*> series(Axis axis, scene::Integrator integrator) const;
};

/// A scene to measure where none is given, as TOML.
extern const char* const kSwingingSheet;

/// What the scene is judged by: positions where the reference knows them well enough to tell a millimetre, else the
/// centre of mass.
Quantity deciding_quantity(const Accuracy& accuracy);

/// Told after each run, with the share of the work that is done.
using EachRun = std::function<void(const Run& run, double done)>;

/// Runs the scene some hundred times. The reference is a run of a method of second order with steps 8 times (with
/// contact twice, or where that fails equally) as fine as the finest measured: of the midpoint rule, or BDF2 where
/// there is contact, which the midpoint rule does not damp. Its uncertainty is the difference to a run with twice its
/// step and, with contact, what perturbing the start by a micrometre changes at the finest step measured. Throws
/// Error(simulation_failed) where the reference itself cannot be computed.
Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each = {});

}  // namespace weft::bench
