// Stability margins of a scene: each of its parameters is varied alone, and stiffness together with the step.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::bench {

/// The varied parameter; the scene's own values are multiplied by a factor.
enum class VariedParameter : std::size_t {
  stiffness,  ///< stretch, shear and bending of all cloths
  step,       ///< time.step, and time.tolerance if the scene has it
  mass,       ///< density of all cloths, and their attached weights
  friction,   ///< coefficients of all cloths, obstacles, characters with their parts, and pairs
  damping,    ///< viscosities, bending friction and air drag of all cloths
  mesh,       ///< cells along each side
};
inline constexpr std::size_t kVariedValues = 6;
std::string_view name_of(VariedParameter axis);

using Factors = std::array<double, kVariedValues>;

/// Faults: surfaces touch or pass through each other, cloth exceeds `max_stretch` by more than a tenth or is pinched by
/// an obstacle, pinned particles lag behind their targets, energy appears from nothing, or the solver leaves unbalanced
/// forces. A trial breaks if it has a fault that the unchanged scene does not have, or starts but does not run to the
/// end. For the unchanged scene itself, every fault counts.
enum class TrialVerdict {
  holds,       ///< ran to the end, with no fault except those of the unchanged scene
  warned,      ///< ran to the end, with a fault that the unchanged scene does not have
  refused,     ///< the simulation ended with an error
  not_finite,  ///< a position is not finite
  too_slow,    ///< aborted: it takes many times as long as the unchanged scene
  impossible,  ///< such a scene cannot be built; margins ignore it
};
std::string_view describe(TrialVerdict verdict);

/// A run of the scene with other values.
struct Trial {
  Factors factors{1, 1, 1, 1, 1, 1};
  TrialVerdict verdict = TrialVerdict::holds;
  /// Faults of this trial that the unchanged scene does not have; for the unchanged scene: all of its faults.
  std::vector<std::string> broken = {};
  bool mends = false;       ///< ran to the end without any fault, not even one of the unchanged scene
  std::string reason = {};  ///< error message if refused or impossible
  double step = 0;          ///< time step [s]; 0 if time.tolerance chooses it
  int frames = 0, steps = 0, rejected_steps = 0, newton_iterations = 0;
  double max_strain = 0;  ///< largest over all frames
  double cpu_s = 0;

  bool breaks() const { return verdict != TrialVerdict::holds && verdict != TrialVerdict::impossible; }
};

struct SceneStability {
  int frames = 0;  ///< number of frames after the start
  Trial as_is;
  std::vector<Trial> trials;  ///< all trials except the unchanged scene

  /// The trial with these factors; nullptr if there is none.
  const Trial* find(const Factors& factors) const;
};

/// All factors tried for one parameter, ascending, including 1.
const std::vector<double>& factors_of(VariedParameter axis);
/// Factors of stiffness and step in the two-dimensional map.
inline constexpr std::array<double, 5> kMapStiffness{0.01, 0.1, 1, 10, 100};
inline constexpr std::array<double, 5> kMapSteps{0.25, 0.5, 1, 2, 4};

/// Runs all frames of the scene once per trial, some fifty trials. Calls `each` after each trial with the fraction of
/// the work done. Returns early with the trials so far if `stop` returns true; throws Error(interrupted) if that
/// happens in the unchanged scene. Also throws what SceneSimulation(scene) throws.
SceneStability measure_scene_stability(
    const scene::Scene& scene, const std::function<void(const Trial&, double done)>& each = {},
    const std::function<bool()>& stop = [] { return false; });

/// The range of a parameter, on one side of the scene's own value, in which the scene holds.
struct Margin {
  VariedParameter axis;
  double holds = 1;               ///< factor farthest from 1 before the first that breaks; 1: none holds
  const Trial* breaks = nullptr;  ///< the trial at that first factor; nullptr if no trial breaks
};
/// One margin below and one above 1 for each parameter that could be varied.
std::vector<Margin> margins_of(const SceneStability& stability);

}  // namespace weft::bench
