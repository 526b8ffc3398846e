#include "forces/air.hpp"

#include <cmath>

#include "mesh/geometry.hpp"

namespace weft::forces {

Air::Air(const mesh::Grid& grid, Index first, const AirParameters& parameters)
    : wind_(parameters.wind), coefficient_(0.5 * parameters.density * parameters.drag) {
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i)
      cells_.push_back({first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i + 1, j + 1),
                        first + grid.index(i, j + 1)});
}

Air::Air(const mesh::Sheet& sheet, Index first, const AirParameters& parameters)
    : wind_(parameters.wind), coefficient_(0.5 * parameters.density * parameters.drag), triangles_(sheet.triangles) {
  for (mesh::Triangle& triangle : triangles_)
    for (Index& corner : triangle) corner += first;
}

void Air::attach(const solver::BlockMatrix& matrix) {
  for (Index i = 0; i < matrix.rows(); ++i) diagonal_.push_back(matrix.diagonal(i));
}

void Air::add(const Evaluation& at) const {
  const std::span<const Vec3> x = at.x;
  // Area vector of a quad, planar or not: half the cross product of its diagonals.
  for (const auto& cell : cells_) push(cell, 0.5 * (x[cell[2]] - x[cell[0]]).cross(x[cell[3]] - x[cell[1]]), at);
  for (const mesh::Triangle& triangle : triangles_) push(triangle, mesh::area_vector(triangle, x), at);
}

// Drag on a face with this area vector.
template <std::size_t Corners>
void Air::push(const std::array<Index, Corners>& face, const Vec3& area, const Evaluation& at) const {
  const double size = area.norm();
  if (size == 0) return;
  const Vec3 n = area / size;
  Vec3 velocity = at.v[face[0]];
  for (std::size_t k = 1; k < Corners; ++k) velocity += at.v[face[k]];
  const double speed = n.dot(velocity / Corners - wind_);
  const double of_speed = coefficient_ * size * std::abs(speed) / Corners;  // of one corner [kg/s]
  for (Index p : face) at.force[p] -= of_speed * speed * n;
  if (at.matrix == nullptr) return;
  const Mat3 damping = 2 * at.rate * of_speed * n * n.transpose();
  for (Index p : face) at.matrix->add(diagonal_[p], damping);
}

}  // namespace weft::forces
