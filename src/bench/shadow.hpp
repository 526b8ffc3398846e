// Projected area of a surface, as used by the drape coefficient.
#pragma once

#include <span>

#include "mesh/topology.hpp"

namespace weft::bench {

/// Area [m²] of the union of the triangles, projected along `up`. The drape coefficient of a specimen on a disc is
/// (shadow − disc) / (specimen − disc) (ISO 9073-9). Integrates along scan lines exactly, and across them by the
/// midpoint rule.
double shadow_area(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions, const Vec3& up);

}  // namespace weft::bench
