// Ways out of obstacles for cloth that begins inside of them, the same for all that hangs together.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "untangle/problem.hpp"
#include "untangle/solid.hpp"

namespace weft::untangle {

/// Particles inside an obstacle that hang together, and how they would best get out.
struct InsideRegion {
  std::size_t cloth = 0, body = 0;
  Vec3 centre = Vec3::Zero();  ///< [m]
  double size = 0;             ///< longest side of the box to half-way to its neighbours [m]
  double farthest = 0;         ///< most that a particle has to move [m]
  double shortest = std::numeric_limits<double>::infinity();  ///< the same on the shortest way that nothing blocks [m]
  double cost = 0;                                            ///< see stretch_cost
  double blocked = 0;       ///< share of its threads that would still go through the body
  std::vector<Move> moves;  ///< out of it, to `above` its surface
};

/// All regions of cloth inside of `solid` at x [m]. Each goes the nearest way, particle by particle, or all in one
/// direction, whichever stretches cloth less: a sheet through the middle of a ball goes over to one side, the smaller
/// one, and a garment that is too small goes outward all round. `above`: height over the surface, per body of cloth
/// [m].
std::vector<InsideRegion> find_inside(const Fabric& fabric, const Solid& solid, std::span<const double> above,
                                      std::span<const Vec3> x);

}  // namespace weft::untangle
