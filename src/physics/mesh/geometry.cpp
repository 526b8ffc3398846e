#include "physics/mesh/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace weft::mesh {

double surface_area(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += area_vector(t, positions).norm();
  return sum;
}

double largest_flat_volume(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  // The ratio of the volume to the area to the power 3/2 is 0.09 for a sphere, and for a flat surface about 1e-16,
  // because of rounding.
  return kRoundoff * std::pow(surface_area(triangles, positions), 1.5);
}

void vertex_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions, std::span<Vec3> normals) {
  std::fill(normals.begin(), normals.end(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 weighted = area_vector(t, positions);
    for (Index v : t) normals[v] += weighted;
  }
  for (Vec3& normal : normals) normal.normalize();
}

Box3 bounding_box(std::span<const Vec3> positions) {
  Box3 box;
  for (const Vec3& x : positions) box.extend(x);
  return box;
}

}  // namespace weft::mesh
