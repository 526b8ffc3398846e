#include "forces/force.hpp"

#include "mesh/geometry.hpp"

namespace weft::forces {

std::vector<double> lumped_masses(const mesh::Grid& grid, double density) {
  std::vector<double> masses(static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i)
      masses[static_cast<std::size_t>(grid.index(i, j))] = density * grid.width_u(i) * grid.width_v(j);
  return masses;
}

std::vector<double> lumped_masses(const mesh::Sheet& sheet, double density) {
  std::vector<double> masses(sheet.rest.size());
  for (const mesh::Triangle& t : sheet.triangles) {
    const double third = density * mesh::area_vector(t, sheet.rest).norm() / 3;
    for (Index i : t) masses[static_cast<std::size_t>(i)] += third;
  }
  return masses;
}

}  // namespace weft::forces
