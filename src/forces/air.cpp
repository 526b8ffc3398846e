#include "forces/air.hpp"

#include <cmath>

#include "mesh/geometry.hpp"

namespace weft::forces {
namespace {

struct Flow {
  const AirParameters& parameters;
  double h;  // [s]
  Air::Taken taken;
  std::span<Vec3> force;
};

// Drag on a face with this area vector, mean velocity and mass of its own.
template <std::size_t Corners>
void push(const std::array<Index, Corners>& face, const Vec3& area, const Vec3& velocity, double mass,
          const Flow& flow) {
  const double size = area.norm();
  if (size == 0) return;
  const Vec3 n = area / size;
  const double speed = n.dot(velocity - flow.parameters.wind);
  const double coefficient = 0.5 * flow.parameters.density * flow.parameters.drag * size;  // c [kg/m]
  const double z = flow.h * coefficient * std::abs(speed) / mass;
  const double limit = flow.taken == Air::Taken::over_the_step ? 1 + z : std::sqrt(1 + z * z);
  const double drag = coefficient * std::abs(speed) * speed / limit;
  for (Index p : face) flow.force[static_cast<std::size_t>(p)] -= 1.0 / Corners * drag * n;
}

}  // namespace

Air::Air(const mesh::Grid& grid, Index first, const AirParameters& parameters) : parameters_(parameters) {
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i)
      cells_.push_back({first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i + 1, j + 1),
                        first + grid.index(i, j + 1)});
}

Air::Air(const mesh::Sheet& sheet, Index first, double cloth_density, const AirParameters& parameters)
    : parameters_(parameters) {
  for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
    mesh::Triangle corners = sheet.triangles[i];
    for (Index& corner : corners) corner += first;
    triangles_.push_back({corners, cloth_density * mesh::rest_area(sheet, i)});
  }
}

void Air::add(std::span<const Vec3> x, std::span<const Vec3> v, std::span<const double> masses, double h, Taken taken,
              std::span<Vec3> force) const {
  const Flow flow{parameters_, h, taken, force};
  for (const auto& cell : cells_) {
    const auto [a, b, c, d] =
        std::array<std::size_t, 4>{static_cast<std::size_t>(cell[0]), static_cast<std::size_t>(cell[1]),
                                   static_cast<std::size_t>(cell[2]), static_cast<std::size_t>(cell[3])};
    // Area vector of a quad, planar or not: half the cross product of its diagonals.
    const Vec3 area = 0.5 * (x[c] - x[a]).cross(x[d] - x[b]);
    // A corner's mass serves up to four cells: a quarter of the corners' sum bounds what this cell may slow down.
    const double mass = 0.25 * (masses[a] + masses[b] + masses[c] + masses[d]);
    push(cell, area, 0.25 * (v[a] + v[b] + v[c] + v[d]), mass, flow);
  }
  for (const auto& [t, mass] : triangles_) {
    push(t, mesh::area_vector(t, x), (v[t[0]] + v[t[1]] + v[t[2]]) / 3, mass, flow);
  }
}

}  // namespace weft::forces
