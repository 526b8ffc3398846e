// Separates surfaces that touch or cross at the start, before the simulation.
//
//   Solid             the inside of an obstacle, and exits from it
//   find_inside       regions of cloth inside an obstacle, and one way out for each
//   CrossingFinder    edges that cross triangles
//   contours          cloth through cloth: islands change sides, lines of crossing are shortened
//   relax             the rest of the cloth follows
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/untangle/problem.hpp"
#include "physics/untangle/ways_out.hpp"

namespace weft::untangle {

struct Options {
  bool self = true;       ///< cloth with cloth
  bool obstacles = true;  ///< cloth with obstacles
};

struct Report {
  int pairs_before = 0, pairs_after = 0;  ///< crossing pairs of triangles
  int rounds = 0;
  double farthest = 0;               ///< largest displacement of a particle [m]
  double stretch = 0;                ///< largest strain of a thread beyond its maximum length
  std::vector<InsideRegion> locked;  ///< regions without a way out; if any, nothing was moved
};

/// Moves particles in x [m] until no triangle of cloth crosses another one or an obstacle, or is closer to it than a
/// tenth of the larger thickness of the two. The number of rounds is bounded; the best state is kept. Deterministic.
Report untangle(const Fabric& fabric, const Options& options, std::span<Vec3> x);

}  // namespace weft::untangle
