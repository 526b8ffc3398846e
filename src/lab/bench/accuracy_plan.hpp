// The user's choices for a measurement of error against run time.
#pragma once

#include <optional>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::bench {

/// If a member is absent, the program chooses its values. An empty list omits the runs of this list, with one
/// exception: without `tolerances`, the scene's integrator still runs with the scene's own time.tolerance.
struct AccuracyPlan {
  std::optional<std::vector<scene::Integrator>> integrators;
  std::optional<std::vector<double>> steps;       ///< relative to the scene's time.step
  std::optional<std::vector<double>> tolerances;  ///< time.tolerance [m]
  std::optional<std::vector<double>> meshes;      ///< number of cells along each side, relative to the scene
  std::optional<int> starts;  ///< number of starts (Run); each has 1 µm more start_noise; default: 1, with contact 3
};
/// Minimum number of starts with contact: the median of fewer starts is no more reliable than a single run.
inline constexpr int kMinStartsWithContact = 3;

}  // namespace weft::bench
