// Conservation of momentum of cloths, ropes and rigid bodies that no constraint or obstacle holds.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::integrator {

/// Diagonal blocks (cloths, ropes, rigid bodies) that terms of `linear` connect form a group;
/// translating a whole group changes no force inside it. Returns for each diagonal block the
/// acceleration [m/s²] of its whole group that makes the residual [N] of the group sum to zero. The
/// acceleration is zero if a constraint, a DiagonalTerm or an obstacle acts on the group.
std::vector<Vec3> missing_accelerations(const solver::LinearSystem& linear, std::span<const double> masses,
                                        std::span<const Vec3> residual);

}  // namespace weft::integrator
