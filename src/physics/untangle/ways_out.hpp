// Finds ways out of obstacles for cloth that starts inside, one for each connected region.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "physics/untangle/problem.hpp"
#include "physics/untangle/solid.hpp"

namespace weft::untangle {

/// A connected region of particles inside a solid, and its best way out.
struct InsideRegion {
  std::size_t cloth = 0, body = 0;
  Vec3 centre = Vec3::Zero();  ///< [m]
  double size = 0;             ///< longest side of its box, extended half-way to neighbours [m]
  double farthest = 0;         ///< largest displacement of a particle [m]
  double shortest = std::numeric_limits<double>::infinity();  ///< as `farthest`, on the shortest unblocked way [m]
  double cost = 0;                                            ///< see stretch_cost; 0 if the whole mesh moves
  double blocked = 0;       ///< fraction of its threads that would still go through the body
  std::vector<Move> moves;  ///< out of the body, to the height `above` over its surface
};

/// Finds all regions of movable cloth inside `solid` at x [m]. In each, either every particle takes its nearest way
/// out, or all move in one direction, or the whole mesh moves; the way that costs least is chosen. For example, a sheet
/// through a ball is moved to the side where its smaller part is, and a garment that is too small outward on all sides.
/// `above`: height over the surface, per body of cloth [m].
std::vector<InsideRegion> find_inside(const Fabric& fabric, const Solid& solid, std::span<const double> above,
                                      std::span<const Vec3> x);

}  // namespace weft::untangle
