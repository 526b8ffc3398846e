// What the engine does with stiff and extreme scenes: solved, refused by name, or wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::bench {

enum class Verdict {
  solved,     ///< went through with finite numbers and no energy from nowhere
  refused,    ///< ended with a named reason; the frames before are kept
  warned,     ///< finite, with more energy than there can be, and the run said so
  unbounded,  ///< the same without a word
  not_finite,
};
inline constexpr std::size_t kVerdicts = 5;
std::string_view describe(Verdict verdict);

struct Outcome {
  Verdict verdict = Verdict::solved;
  std::string reason;  ///< of a refusal
  int frames = 0;      ///< finished, the start not counted
  int steps = 0, rejected_steps = 0, newton_iterations = 0;
  double energy_gain = 0;  ///< largest mechanical energy above that of the start, in shares of what is allowed
  double max_speed = 0;    ///< largest of a particle, between two frames [m/s]
  double max_strain = 0;   ///< in the last frame
  double cpu_s = 0;
};

/// Energy that a scene may gain [J]: what its driven pins and bodies can put in. 0: nothing is driven, so none but for
/// the share that solving to a tolerance costs.
struct EnergyLimit {
  double driven = 0;
};

/// Simulates `frames` frames. Never throws for what a scene does.
Outcome try_scene(const scene::Scene& scene, int frames, const EnergyLimit& limit = {});

/// A scene at the edge of what anyone would ask for.
struct ExtremeCase {
  std::string name;  ///< of its file
  std::string what;
  std::string text;  ///< the scene, TOML
  int frames = 0;
  EnergyLimit limit;
};
const std::vector<ExtremeCase>& extreme_cases();

/// One cell of the stability map.
struct MapCell {
  scene::Integrator integrator;
  double stiffness;  ///< of stretch [N/m]
  double step;       ///< [s]
  Outcome outcome = {};
  /// How long it ran, in periods of the swing and of the stiffest mode of the mesh.
  double swings = 0, stiffest_periods = 0;
};

/// Of the sheet of the map [s]: as a plate that hangs from its upper edge; of threads that vibrate against each other
/// from particle to particle.
double swing_period();
double stiffest_period(double stiffness);

/// A sheet of 11 × 11 held at two corners swings down: eleven powers of ten of stiffness, seven steps from 1e-5 to
/// 0.2 s, three integrators; two swings each, or 25,000 steps where these are fewer. `each` is told of each cell as it
/// is done.
std::vector<MapCell> stability_map(const std::function<void(const MapCell&)>& each = {});

}  // namespace weft::bench
