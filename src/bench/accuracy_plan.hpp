// What a measurement of error against run time varies.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace weft::bench {

/// Lists that are not given are the program's choice; empty ones leave the axis out.
struct AccuracyPlan {
  std::optional<std::vector<scene::Integrator>> integrators;
  std::optional<std::vector<double>> steps;       ///< times the scene's time.step
  std::optional<std::vector<double>> tolerances;  ///< time.tolerance [m]
  std::optional<std::vector<double>> meshes;      ///< cells along each side, times the scene's
  std::optional<int> starts;                      ///< each moved by a micrometre more; 1, or with contact 3
};
/// Fewest starts of which a median says more than a single run.
inline constexpr int kLeastStartsWithContact = 3;

}  // namespace weft::bench
