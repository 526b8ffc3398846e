#include "physics/mesh/geometry.hpp"

#include <algorithm>

namespace weft::mesh {

double surface_area(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += area_vector(t, positions).norm();
  return sum;
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
