// Momentum of cloth on which nothing acts from outside but weight and air.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "solver/linear_system.hpp"

namespace weft::integrator {

/// Of each part of a system the acceleration [m/s²] by which the group that it is in has to be changed as a whole, so
/// that its residual [N] sums to zero; zero where a constraint or an obstacle acts on the group. Parts are in one group
/// where terms join them. A translation of a group changes no force in it.
std::vector<Vec3> missing_accelerations(const solver::LinearSystem& linear, std::span<const double> masses,
                                        std::span<const Vec3> residual);

}  // namespace weft::integrator
