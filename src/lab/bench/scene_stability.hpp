// Stability margins of a scene: how far parameters can be varied until the simulation breaks. Each parameter is varied
// alone, and stiffness together with the step.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::bench {

/// A parameter that is varied: a factor multiplies the scene's own values.
enum class VariedParameter : std::size_t {
  stiffness,  ///< stretch, shear and bending of all cloths and ropes
  step,       ///< time.step, and time.tolerance if the scene has it
  mass,       ///< density of all cloths, mass of all ropes, and their attached weights
  friction,   ///< coefficients of all cloths, ropes, obstacles, characters with their parts, and pairs
  damping,    ///< viscosities, bending friction and air drag of all cloths and ropes
  mesh,       ///< number of cells along each side
};
inline constexpr std::size_t kVariedValues = 6;
std::string_view name_of(VariedParameter axis);

using Factors = std::array<double, kVariedValues>;

/// Result of a trial. The faults of a trial are:
/// - surfaces touch or pass through each other,
/// - cloth exceeds `max_stretch` by more than a tenth, or is pinched by an obstacle,
/// - pinned particles lag behind their targets,
/// - energy appears without a source, or the solver leaves unbalanced forces.
/// A fault is new if the unchanged scene does not have it. In the trial of the unchanged scene itself, all faults count
/// as new. A trial breaks if it has a new fault, or if it starts but does not run to the end.
enum class TrialVerdict {
  holds,       ///< ran to the end, without a new fault
  warned,      ///< ran to the end, with a new fault
  refused,     ///< the simulation ended with an error
  not_finite,  ///< a position is not finite
  too_slow,    ///< aborted, because it takes many times as long as the unchanged scene
  impossible,  ///< no scene with these values can be built; margins ignore the trial
};
inline constexpr std::size_t kTrialVerdicts = 6;
std::string_view describe(TrialVerdict verdict);

/// A run of the scene with other values, or of the unchanged scene.
struct Trial {
  Factors factors{1, 1, 1, 1, 1, 1};
  TrialVerdict verdict = TrialVerdict::holds;
  std::vector<std::string> new_faults = {};  ///< see TrialVerdict
  bool is_free_of_faults = false;            ///< whether the trial ran to the end without any fault, new or not
  std::string reason = {};                   ///< error message, if the verdict is `refused` or `impossible`
  double step = 0;                           ///< time step [s]; 0 if time.tolerance chooses it
  int frames = 0, steps = 0, rejected_steps = 0, newton_iterations = 0;
  double max_strain = 0;  ///< maximum over all frames
  double cpu_s = 0;

  bool breaks() const { return verdict != TrialVerdict::holds && verdict != TrialVerdict::impossible; }
};

/// Results of all trials.
struct SceneStability {
  int frames = 0;             ///< number of frames after the start
  Trial as_is;                ///< the unchanged scene
  std::vector<Trial> trials;  ///< all other trials

  /// The trial with these factors; nullptr if there is none.
  const Trial* find(const Factors& factors) const;
};

/// All factors of one parameter, in ascending order, including 1. Only those that change the
/// simulation of the scene are tried.
const std::vector<double>& factors_of(VariedParameter axis);
/// Factors of stiffness and step that are varied together. The report shows these trials as a map, a grid of stiffness
/// and step. All combinations are tried, except those in which a factor changes nothing.
inline constexpr std::array<double, 5> kMapStiffness{0.01, 0.1, 1, 10, 100};
inline constexpr std::array<double, 5> kMapSteps{0.25, 0.5, 1, 2, 4};

/// Runs all frames of the scene for each of about fifty trials. After each trial, calls `each` with the fraction of
/// trials that is done. If `stop` returns true, returns the trials so far; if this happens in the unchanged scene,
/// throws Error(interrupted). Also throws what SceneSimulation(scene) throws.
SceneStability measure_scene_stability(
    const scene::Scene& scene, const std::function<void(const Trial&, double done)>& each = {},
    const std::function<bool()>& stop = [] { return false; });

/// How far a parameter can be varied to one side of the scene's own value until a trial breaks.
struct Margin {
  VariedParameter axis;
  double holds = 1;               ///< last factor, from 1 outward, before a trial breaks; 1 if the first trial breaks
  const Trial* breaks = nullptr;  ///< the first trial that breaks, from 1 outward; nullptr if none breaks
};
/// One margin below and one above 1 for each parameter that could be varied.
std::vector<Margin> margins_of(const SceneStability& stability);

}  // namespace weft::bench
