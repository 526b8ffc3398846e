// The shadow of a shape: what the drape of a cloth is measured by.
#pragma once

#include <span>

#include "mesh/topology.hpp"

namespace weft::bench {

/// Area [m²] that triangles cover, seen along `up`, each place counted once. With it the drape coefficient of a
/// specimen on a disc is (shadow − disc) / (specimen − disc) (ISO 9073-9). Exact along the lines of a fine raster, by
/// the midpoint rule across them.
double shadow_area(std::span<const mesh::Triangle> triangles, std::span<const Vec3> positions, const Vec3& up);

}  // namespace weft::bench
