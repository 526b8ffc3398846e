// Tests whether the simulation solves stiff and extreme scenes, refuses them, or gives wrong results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::bench {

enum class Verdict {
  solved,      ///< ran to the end, finite, with at most the allowed energy
  refused,     ///< ended with an error
  warned,      ///< ran to the end, finite, with more energy than allowed; some frame has a warning
  unbounded,   ///< like `warned`, but no frame has a warning
  not_finite,  ///< a position or the energy is not finite
};
inline constexpr std::size_t kVerdicts = 5;
std::string_view describe(Verdict verdict);

struct Outcome {
  Verdict verdict = Verdict::solved;
  std::string reason;  ///< error message, if the verdict is `refused`
  int frames = 0;      ///< number of finished frames after the start
  int steps = 0, rejected_steps = 0, newton_iterations = 0;
  double energy_gain = 0;  ///< largest increase of mechanical energy since the start, relative to the allowed increase
  double max_speed = 0;    ///< largest mean speed of a particle between two frames [m/s]
  double max_strain = 0;   ///< largest strain in the last frame
  double cpu_s = 0;
};

/// Simulates `frames` frames, or fewer if a position or the energy is not finite. If the simulation
/// throws Error, returns Verdict::refused. `driven`: largest energy that moving pins and bodies can add [J]; 0: none
/// move. The energy may increase by this and, for errors of the solver, by 0.1 times the energies in play
/// (stability.cpp).
Outcome try_scene(const scene::Scene& scene, int frames, double driven = 0);

/// A scene with extreme parameters.
struct ExtremeCase {
  std::string name;  ///< file name without ending
  std::string what;
  std::string text;  ///< the scene as TOML
  int frames = 0;
  double driven = 0;  ///< see try_scene() [J]
};
const std::vector<ExtremeCase>& extreme_cases();

/// One cell of the stability map.
struct MapCell {
  scene::Integrator integrator;
  double stiffness;  ///< stretch stiffness [N/m]
  double step;       ///< [s]
  Outcome outcome = {};
  /// Simulated duration, relative to swing_period() and relative to stiffest_period().
  double swings = 0, stiffest_periods = 0;
};

/// Period of the map's sheet if it swung about its upper edge as a rigid plate [s].
double swing_period();
/// Period of the stiffest mode of the map's sheet, in which neighbouring particles of a thread move oppositely [s].
double stiffest_period(double stiffness);

/// Simulates a sheet of 11 × 11 particles that is held at two corners and swings down. Each
/// combination of eleven stiffnesses (1e-2 to 1e8 N/m), seven steps (1e-5 to 0.2 s) and three
/// integrators is a cell. Each cell runs for two swings or 25,000 steps, whichever is shorter,
/// rounded up to whole frames. Calls `each` after each cell.
std::vector<MapCell> stability_map(const std::function<void(const MapCell&)>& each = {});

}  // namespace weft::bench
