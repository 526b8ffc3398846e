// Cloth gives way to what was moved: threads and folds get back to lengths that they may have, particle by particle.
#pragma once

#include <span>

#include "untangle/problem.hpp"
#include "untangle/solid.hpp"

namespace weft::untangle {

/// Sweeps over all links in their order, each put right at once (position-based dynamics without time: Müller et al.,
/// "Position Based Dynamics", 2007). After every few sweeps what is too low over a solid is raised to `above` its
/// surface (per body of cloth, [m]).
void relax(const Fabric& fabric, std::span<const Solid> solids, std::span<const double> above, int sweeps,
           std::span<Vec3> x);

/// Particles that are lower than that, the nearest way out.
void raise(const Fabric& fabric, std::span<const Solid> solids, std::span<const double> above, std::span<Vec3> x);

/// Moves movable particles around these, as far as `rings` edges away, to the middle of their neighbours, `times` over.
void smooth(const Fabric& fabric, std::span<const Index> particles, int rings, int times, std::span<Vec3> x);

}  // namespace weft::untangle
