// Areas, normals and bounding boxes of triangle meshes.
#pragma once

#include <span>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Half the cross product of two sides: length = area [m²], direction = front normal.
inline Vec3 area_vector(const Triangle& t, std::span<const Vec3> x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[t[k]]; };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/// Sum of the triangle areas [m²].
double surface_area(std::span<const Triangle> triangles, std::span<const Vec3> positions);

/// Volume [m³] up to which a closed surface counts as flat: smaller volumes may be rounding errors.
double largest_flat_volume(std::span<const Triangle> triangles, std::span<const Vec3> positions);

/// Writes one unit normal per vertex, the normalised area-weighted mean over its triangles, into
/// `normals`; zero if the area vectors of these triangles add up to zero. Allocates no memory.
void vertex_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions, std::span<Vec3> normals);

/// Smallest axis-aligned box around the points [m]; empty without points.
Box3 bounding_box(std::span<const Vec3> positions);

}  // namespace weft::mesh
