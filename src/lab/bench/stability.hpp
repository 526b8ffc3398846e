// Tests how the engine handles stiff and extreme scenes: it solves them, refuses them with a reason, or is wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::bench {

enum class Verdict {
  solved,     ///< ran to the end with finite numbers and without unexplained energy
  refused,    ///< ended with a stated reason; earlier frames are kept
  warned,     ///< finite, but with more energy than allowed; some frame has a warning
  unbounded,  ///< as `warned`, but without any warning
  not_finite,
};
inline constexpr std::size_t kVerdicts = 5;
std::string_view describe(Verdict verdict);

struct Outcome {
  Verdict verdict = Verdict::solved;
  std::string reason;  ///< error message of a refusal
  int frames = 0;      ///< number of finished frames after the start
  int steps = 0, rejected_steps = 0, newton_iterations = 0;
  double energy_gain = 0;  ///< largest increase of mechanical energy since the start, relative to the allowed one
  double max_speed = 0;    ///< largest speed of a particle between two frames [m/s]
  double max_strain = 0;   ///< in the last frame
  double cpu_s = 0;
};

/// Largest increase of energy that is allowed because pins and bodies are driven [J]. A fixed fraction of the energies
/// in play is allowed in addition, for solver tolerances.
struct EnergyLimit {
  double driven = 0;
};

/// Simulates `frames` frames. Failures of the simulation are returned as a verdict, never thrown.
Outcome try_scene(const scene::Scene& scene, int frames, const EnergyLimit& limit = {});

/// A scene with extreme parameters.
struct ExtremeCase {
  std::string name;  ///< stem of its file name
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
  /// Simulated duration, relative to swing_period() and to stiffest_period().
  double swings = 0, stiffest_periods = 0;
};

/// Period of the map's sheet as a rigid plate that swings about its upper edge [s].
double swing_period();
/// Period of neighbouring particles of a thread of the map's sheet that vibrate against each other [s].
double stiffest_period(double stiffness);

/// Simulates a sheet of 11 × 11 particles, held at two corners, that swings down, for each combination of eleven powers
/// of ten of stiffness [N/m], seven steps from 1e-5 to 0.2 s, and three integrators. Each cell runs for two swings or
/// 25,000 steps, whichever is shorter. Calls `each` after each cell.
std::vector<MapCell> stability_map(const std::function<void(const MapCell&)>& each = {});

}  // namespace weft::bench
