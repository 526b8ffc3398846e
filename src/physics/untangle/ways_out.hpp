// Finds ways out of forbidden regions (solid bodies, floors, layers; here all called solids) for cloth that starts
// inside, one for each connected region of cloth.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "physics/untangle/forbidden_region.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// A connected region of particles inside a solid, and its best way out.
struct InsideRegion {
  std::size_t cloth = 0, body = 0;  ///< numbers of the cloth and of the solid among the bodies
  Vec3 centre = Vec3::Zero();       ///< [m]
  double size = 0;                  ///< longest side of its bounding box, which is extended half-way to neighbours [m]
  double farthest = 0;              ///< largest displacement of a particle [m]
  /// Smallest value of `farthest` among all ways out, chosen or not, after which no thread goes through the solid [m];
  /// infinite if there is no such way.
  double shortest = std::numeric_limits<double>::infinity();
  double blocked = 0;       ///< fraction of its threads that would still go through the solid after the moves
  std::vector<Move> moves;  ///< out of the solid, to UntangleInput::min_height over its surface
};

/// Finds all regions that are inside `solid` at x [m], of cloth that can move (UntangleInput::can_move). Behind a
/// layer, only regions count that reach into its bounding box or cross it. Chooses the cheapest way out of each: every
/// particle goes to its nearest exit, or all particles move in one direction, or the whole mesh moves. For example, a
/// sheet that cuts a ball into two parts moves to the side of the smaller part of the ball; a garment that is too small
/// moves outward on all sides.
std::vector<InsideRegion> find_inside(const UntangleInput& input, const ForbiddenRegion& solid,
                                      std::span<const Vec3> x);

}  // namespace weft::untangle
