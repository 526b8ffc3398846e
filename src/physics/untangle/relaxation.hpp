// Relaxation: the rest of the cloth follows moved particles, so that links along edges (threads) and across them
// (bending) regain allowed lengths.
#pragma once

#include <span>

#include "physics/untangle/problem.hpp"
#include "physics/untangle/solid.hpp"

namespace weft::untangle {

/// Sweeps over all links in order and corrects each before the next one is read, links of bending only in part
/// (position-based dynamics without time: Müller et al., "Position Based Dynamics", 2007). After every few sweeps and
/// after the last one, calls raise(). `above`: minimum height over solids [m], per body.
void relax(const Fabric& fabric, std::span<const Solid> solids, std::span<const double> above, int sweeps,
           std::span<Vec3> x);

/// Raises movable particles that are lower than `above` over a solid to the height `above`, in the direction of the
/// nearest exit.
void raise(const Fabric& fabric, std::span<const Solid> solids, std::span<const double> above, std::span<Vec3> x);

/// Moves movable particles within `rings` edges of the given ones to the centre of their neighbours, `times` times. For
/// a particle on the border, only neighbours on the border count.
void smooth(const Fabric& fabric, std::span<const Index> particles, int rings, int times, std::span<Vec3> x);

}  // namespace weft::untangle
