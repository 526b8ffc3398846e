// Separates surfaces that touch or cross at the start, before the simulation.
//
//   ForbiddenRegion   a region where cloth may not be, such as the inside of an obstacle; finds exits
//   find_inside       finds connected regions of cloth inside a ForbiddenRegion, and one way out for each
//   CrossingFinder    finds edges that cross triangles
//   contours.hpp      cloth through cloth: moves islands that are cut off, shortens lines of crossing; pushes cloth
//                     that crosses solids out of them
//   relax             moves the cloth so that threads return to allowed lengths
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/untangle/problem.hpp"
#include "physics/untangle/ways_out.hpp"

namespace weft::untangle {

struct Report {
  int pairs_before = 0, pairs_after = 0;  ///< crossing pairs of triangles
  int rounds = 0;                         ///< number of rounds that tried to reduce the number of crossings
  double farthest = 0;                    ///< largest displacement of a particle [m]
  double stretch = 0;  ///< largest excess of a thread over its maximum length, relative to that length
  std::vector<InsideRegion> locked_regions;  ///< regions without a way out; if there are any, nothing was moved
};

/// Moves particles in x [m] until no triangle of cloth crosses another triangle, and the gap between any two surfaces
/// is at least a tenth of the larger of their thicknesses. If `self` is false, pairs of two cloths do not count. If
/// crossings remain after a bounded number of rounds, keeps the state with the fewest crossing pairs. If only gaps
/// remain too small, keeps the last state without crossings. If a region is locked, moves nothing. The result is
/// deterministic.
Report untangle(const UntangleInput& input, bool self, std::span<Vec3> x);

}  // namespace weft::untangle
