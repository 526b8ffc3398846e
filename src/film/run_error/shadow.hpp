// Projected area of a surface, as used by the drape coefficient.
#pragma once

#include <span>

#include "physics/mesh/topology.hpp"

namespace weft::run_error {

/// Area [m²] of the union of the triangles, projected along `up`. The drape coefficient of a specimen on a disc is
/// (shadow − disc) / (specimen − disc), with the areas of all three (ISO 9073-9). The integral is exact along scan
/// lines, and uses the midpoint rule across them.
double shadow_area(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions, const Vec3& up);

}  // namespace weft::run_error
