#include "forces/air.hpp"

#include <cmath>

namespace weft::forces {

Air::Air(const mesh::Grid& grid, Index first, const AirParameters& parameters) : parameters_(parameters) {
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i)
      cells_.push_back({first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i + 1, j + 1),
                        first + grid.index(i, j + 1)});
}

void Air::add(std::span<const Vec3> x, std::span<const Vec3> v, std::span<const double> masses, double h,
              std::span<Vec3> force) const {
  for (const auto& cell : cells_) {
    const auto [a, b, c, d] =
        std::array<std::size_t, 4>{static_cast<std::size_t>(cell[0]), static_cast<std::size_t>(cell[1]),
                                   static_cast<std::size_t>(cell[2]), static_cast<std::size_t>(cell[3])};
    // Area vector of a quad, planar or not: half the cross product of its diagonals.
    const Vec3 area = 0.5 * (x[c] - x[a]).cross(x[d] - x[b]);
    const double size = area.norm();
    if (size == 0) continue;
    const Vec3 n = area / size;
    const double speed = n.dot(0.25 * (v[a] + v[b] + v[c] + v[d]) - parameters_.wind);
    const double coefficient = 0.5 * parameters_.density * parameters_.drag * size;  // c [kg/m]
    // A corner's mass serves up to four cells: a quarter of the corners' sum bounds what this cell may slow down.
    const double mass = 0.25 * (masses[a] + masses[b] + masses[c] + masses[d]);
    const double drag = coefficient * std::abs(speed) * speed / (1 + h * coefficient * std::abs(speed) / mass);
    for (std::size_t p : {a, b, c, d}) force[p] -= 0.25 * drag * n;
  }
}

}  // namespace weft::forces
