// Separates crossed cloth: moves islands that lines of crossing cut off, shortens lines, pushes cloth out of solids.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "physics/untangle/crossings.hpp"
#include "physics/untangle/forbidden_region.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// A cloth and the surface that it crosses, which may be itself.
struct CrossedPair {
  std::size_t cloth, other;
  friend auto operator<=>(const CrossedPair&, const CrossedPair&) = default;
};

/// Lists each cloth with each surface that its edges cross in `crossings`. Ignores crossings with solids, floors and
/// layers.
std::vector<CrossedPair> list_crossed_pairs(const UntangleInput& input, std::span<const Crossing> crossings);

/// Lines of crossing divide a mesh into islands. Returns moves for each island that may move, the smallest island
/// first. The moves take the island to the side of the crossed surface on which the mesh beside the island is (similar
/// to flood filling in Baraff, Witkin & Kass, "Untangling Cloth", 2003). The largest island of a mesh and islands with
/// held particles do not move. The moves flatten the island onto that side, or fold it over the line of crossing if
/// folding costs at least a tenth less (stretch_cost()). An island does not move either if an island beside it, or a
/// triangle that it crosses, already moves. Thus, if islands cut each other off, only the smallest moves. Ignores
/// crossings with solids, floors and layers. `surfaces`: the broad phase, refitted at x. The island moves to
/// UntangleInput::min_height over the crossed surface. `only`: restricts the search to this pair. If its two
/// surfaces differ, `only->other` is extended beyond its border as a plane, so that a line of crossing that ends at
/// this border still divides `only->cloth`.
std::vector<std::vector<Move>> move_cut_off_islands(const UntangleInput& input, std::span<const Crossing> crossings,
                                                    const collision::BroadPhase& surfaces,
                                                    const std::optional<CrossedPair>& only, std::span<const Vec3> x);

/// Moves each crossing edge and the triangle that it crosses in opposite directions, so that the line of crossing
/// shortens fastest (Volino & Magnenat-Thalmann, "Resolving Surface Collisions through Intersection Contour
/// Minimization", 2006). No particle moves farther than `length` [m]. Ignores crossings with solids, floors and layers.
void shorten_contours(const UntangleInput& input, std::span<const Crossing> crossings, double length,
                      std::span<Vec3> x);

/// Pushes edges and triangles of cloth out of each solid, floor or layer that they cross. They can cross a solid
/// although all their particles are outside. Raises their crossing points, and the quarter points of edges, to at least
/// UntangleInput::min_height.
void push_out_of_solids(const UntangleInput& input, std::span<const Crossing> crossings,
                        std::span<const ForbiddenRegion> solids, std::span<Vec3> x);

}  // namespace weft::untangle
