// How far a scene is from where it breaks: its own values varied, one at a time, and stiffness with the step.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::bench {

/// What is varied, by a factor on the scene's own values.
enum class Varied : std::size_t {
  stiffness,  ///< stretch, shear and bending of all cloths
  step,       ///< time.step, or time.tolerance
  mass,       ///< density of all cloths, and their weights
  friction,   ///< of all cloths, obstacles, characters and pairs
  damping,    ///< viscosities, friction of bending and air drag of all cloths
  mesh,       ///< cells along each side
};
inline constexpr std::size_t kVariedValues = 6;
std::string_view name_of(Varied axis);

using Factors = std::array<double, kVariedValues>;

enum class TrialVerdict {
  holds,       ///< went through without what counts as broken
  warned,      ///< went through, and something broke on the way
  refused,     ///< the simulation ended with a reason
  not_finite,  ///< a position is no number
  too_slow,    ///< given up: it takes many times as long as the scene itself
  impossible,  ///< no such scene: it is not counted
};
std::string_view describe(TrialVerdict verdict);

/// A run of the scene with other values.
struct Trial {
  Factors factors{1, 1, 1, 1, 1, 1};
  TrialVerdict verdict = TrialVerdict::holds;
  /// What broke that does not break in the scene as it is; of that scene: all of it.
  std::vector<std::string> broken = {};
  bool mends = false;       ///< whether nothing breaks, not even what breaks in the scene as it is
  std::string reason = {};  ///< of a refusal
  double step = 0;          ///< largest of the steps [s]; 0: time.tolerance chooses them
  int frames = 0, steps = 0, rejected_steps = 0, newton_iterations = 0;
  double max_strain = 0;  ///< largest of all frames
  double cpu_s = 0;

  bool breaks() const { return verdict != TrialVerdict::holds && verdict != TrialVerdict::impossible; }
};

struct SceneStability {
  int frames = 0;  ///< of the scene, the start not counted
  Trial as_is;
  std::vector<Trial> trials;  ///< without the scene as it is

  /// The trial with these factors; nullptr where there is none.
  const Trial* find(const Factors& factors) const;
};

/// All factors that are tried for one value, ascending, with 1.
const std::vector<double>& factors_of(Varied axis);
/// Those of stiffness and step in the map of both.
inline constexpr std::array<double, 5> kMapStiffness{0.01, 0.1, 1, 10, 100};
inline constexpr std::array<double, 5> kMapSteps{0.25, 0.5, 1, 2, 4};

/// Runs all frames of the scene for each trial: some fifty times. `each` is told of each trial with the share of the
/// work that is done. Ends early, with what there is, where `stop` says so. Throws what the scene as it is throws, but
/// for Error(simulation_failed).
SceneStability measure_scene_stability(
    const scene::Scene& scene, const std::function<void(const Trial&, double done)>& each = {},
    const std::function<bool()>& stop = [] { return false; });

/// Up to where values hold on one side of the scene's own.
struct Margin {
  Varied axis;
  double holds = 1;               ///< the factor farthest from 1 before the first that breaks
  const Trial* breaks = nullptr;  ///< that one; nullptr: none that was tried breaks
};
/// Below and above 1, of each axis that could be varied.
std::vector<Margin> margins_of(const SceneStability& stability);

}  // namespace weft::bench
