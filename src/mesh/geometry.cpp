#include "mesh/geometry.hpp"

#include <algorithm>

namespace weft::mesh {

double surface_area(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += area_vector(t, positions).norm();
  return sum;
}

double enclosed_volume(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  if (positions.empty()) return 0;
  // Signed tetrahedra over each triangle. Their common tip lies on the mesh: far from it, large terms would cancel.
  const Vec3 tip = positions.front();
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += area_vector(t, positions).dot(positions[static_cast<std::size_t>(t[0])] - tip) / 3;
  return sum;
}

void vertex_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions, std::span<Vec3> normals) {
  std::fill(normals.begin(), normals.end(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 weighted = area_vector(t, positions);
    for (Index v : t) normals[static_cast<std::size_t>(v)] += weighted;
  }
  for (Vec3& normal : normals) normal.normalize();
}

Box3 bounding_box(std::span<const Vec3> positions) {
  Box3 box;
  for (const Vec3& x : positions) box.extend(x);
  return box;
}

}  // namespace weft::mesh
