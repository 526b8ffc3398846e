// Separates crossed cloth: moves islands that crossings cut off, shortens lines of crossing, pushes cloth out of
// solids.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "physics/untangle/crossings.hpp"
#include "physics/untangle/problem.hpp"
#include "physics/untangle/solid.hpp"

namespace weft::untangle {

/// A cloth and the surface that it crosses, which may be itself.
struct CrossedPair {
  std::size_t cloth, other;
  friend auto operator<=>(const CrossedPair&, const CrossedPair&) = default;
};

/// Each cloth whose edges are in these crossings, paired with each surface that they cross, except solids, floors and
/// layers.
std::vector<CrossedPair> list_crossed_pairs(const Fabric& fabric, std::span<const Crossing> crossings);

/// Lines of crossing cut islands off from the largest island of a mesh. Returns moves for each of these islands, the
/// smallest first. They take an island to the side of the crossed surface on which the largest island is (similar to
/// flood filling in Baraff, Witkin & Kass, "Untangling Cloth", 2003). An island is flattened onto the other side, or
/// folded over the line of crossing if folding costs a tenth less (see stretch_cost). If islands cut each other off,
/// only the smallest moves. Ignores crossings with solids, floors and layers. `above`: height over the other surface,
/// per body of cloth [m]. `only`: restricts the search to one pair; if its surfaces differ, the other one is extended
/// beyond its border as a plane, so that a line that ends at this border still cuts the cloth. `surfaces`: the broad
/// phase, refitted at x.
std::vector<std::vector<Move>> move_cut_off_islands(const Fabric& fabric, std::span<const Crossing> crossings,
                                                    const collision::BroadPhase& surfaces,
                                                    std::span<const double> above,
                                                    const std::optional<CrossedPair>& only, std::span<const Vec3> x);

/// Moves each crossing edge and triangle against each other, along the direction in which their line of crossing
/// shortens fastest (Volino & Magnenat-Thalmann, "Resolving Surface Collisions through Intersection Contour
/// Minimization", 2006). No particle moves farther than `length` [m]. Ignores crossings with solids, floors and layers.
void shorten_contours(const Fabric& fabric, std::span<const Crossing> crossings, double length, std::span<Vec3> x);

/// Pushes edges and triangles of cloth that cross a solid outward; they can cross it even if all their particles are
/// outside. `above`: height over the solid that the crossing points get at least, per body of cloth [m].
void push_out_of_solids(const Fabric& fabric, std::span<const Crossing> crossings, std::span<const Solid> solids,
                        std::span<const double> above, std::span<Vec3> x);

}  // namespace weft::untangle
