// Projected area of a surface, for the drape coefficient.
#pragma once

#include <span>

#include "physics/mesh/topology.hpp"

namespace weft::run_error {

/// Area of the shadow of the triangles, which is the union of their projections along `up` [m²].
/// The drape coefficient of a specimen on a disc is (shadow − disc) / (specimen − disc), where each
/// word stands for an area (ISO 9073-9). The integral is exact along scan lines; across them, it
/// uses the midpoint rule.
double shadow_area(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions, const Vec3& up);

}  // namespace weft::run_error
