// Starts that touch or cross are taken apart, before anything is simulated.
//
//   Solid             the inside of an obstacle, and ways out of it
//   find_inside       cloth inside of it, and where that goes as a whole
//   CrossingFinder    where edges go through triangles
//   contours          cloth through cloth: parts that are cut off change sides, lines of crossing get shorter
//   relax             the rest of the cloth follows
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "untangle/problem.hpp"
#include "untangle/ways_out.hpp"

namespace weft::untangle {

struct Options {
  bool self = true;       ///< cloth with cloth
  bool obstacles = true;  ///< cloth with obstacles
};

struct Report {
  int pairs_before = 0, pairs_after = 0;  ///< of triangles that cross
  int rounds = 0;
  double farthest = 0;               ///< most that a particle was moved [m]
  double stretch = 0;                ///< most that a thread is longer than at rest and at the start, as a share
  std::vector<InsideRegion> locked;  ///< regions for which there is no way out; then nothing was moved
};

/// Moves particles among x [m] until no triangle of cloth crosses another or an obstacle, and none touches: less than a
/// tenth of cloth's thickness apart. In a bounded number of rounds; the best place found is kept. Deterministic.
Report untangle(const Fabric& fabric, const Options& options, std::span<Vec3> x);

}  // namespace weft::untangle
