// Relaxation: after some particles were moved, moves the cloth so that links along edges (threads) and across edges
// (bending) return to allowed lengths.
#pragma once

#include <span>

#include "physics/untangle/forbidden_region.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// Sweeps `sweeps` times over all links in order, and corrects the length of each link before it reads the next one
/// (Gauss-Seidel; position-based dynamics without time: Müller et al., "Position Based Dynamics", 2007). Corrects only
/// a fifth of the error of a bending link. After every fifth sweep and after the last one, calls raise().
void relax(const UntangleInput& input, std::span<const ForbiddenRegion> solids, int sweeps, std::span<Vec3> x);

/// Moves movable particles that are inside a solid, or less than UntangleInput::min_height over it, to that height over
/// their nearest exit (ForbiddenRegion::Exit).
void raise(const UntangleInput& input, std::span<const ForbiddenRegion> solids, std::span<Vec3> x);

/// Moves movable particles within `rings` edges of the given ones to the mean of their neighbours,
/// `times` times. For a particle on the border, only neighbours on the border count, so that it
/// stays near the border; with fewer than two of them, the particle does not move.
void smooth(const UntangleInput& input, std::span<const Index> particles, int rings, int times, std::span<Vec3> x);

}  // namespace weft::untangle
