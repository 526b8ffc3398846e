// Cloth through cloth: what the lines in which surfaces cross cut off, and how they are made shorter.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "untangle/crossings.hpp"
#include "untangle/problem.hpp"
#include "untangle/solid.hpp"

namespace weft::untangle {

/// A cloth and what it goes through, which may be itself.
struct Through {
  std::size_t cloth, other;
  friend auto operator<=>(const Through&, const Through&) = default;
};

/// Those of these crossings, without solids.
std::vector<Through> list_through(const Fabric& fabric, std::span<const Crossing> crossings);

/// Moves that take the parts that crossings cut off from the larger rest of their cloth to that rest's side of what
/// they go through, part by part, the smallest first (as flood filling does in Baraff, Witkin & Kass, "Untangling
/// Cloth", 2003): folded over the line in which they cross, or flattened onto the other side, whichever stretches less.
/// Of parts that cut each other off only the smallest moves. `above`: height over the other surface, per body of cloth
/// [m]. `only`: looks at nothing else, and where a line ends within that cloth, at a border of the other, the other is
/// taken to go on as a plane. `surfaces`: fitted to x.
std::vector<std::vector<Move>> move_cut_off_parts(const Fabric& fabric, std::span<const Crossing> crossings,
                                                  const collision::BroadPhase& surfaces, std::span<const double> above,
                                                  const std::optional<Through>& only, std::span<const Vec3> x);

/// Moves each edge and the triangle that it goes through against each other, along the direction in which the line of
/// their crossing gets shorter the fastest (Volino & Magnenat-Thalmann, "Resolving Surface Collisions through
/// Intersection Contour Minimization", 2006), no particle by more than `length` [m].
void shorten_contours(const Fabric& fabric, std::span<const Crossing> crossings, double length, std::span<Vec3> x);

/// Pushes edges and triangles of cloth that go through a solid, with their particles outside of it, outward.
void push_off(const Fabric& fabric, std::span<const Crossing> crossings, std::span<const Solid> solids,
              std::span<const double> above, std::span<Vec3> x);

}  // namespace weft::untangle
