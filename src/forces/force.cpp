#include "forces/force.hpp"

namespace weft::forces {

std::vector<double> lumped_masses(const mesh::Grid& grid, double density) {
  std::vector<double> masses(static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i)
      masses[static_cast<std::size_t>(grid.index(i, j))] =
          density * line_width(i, grid.nu, grid.lu) * line_width(j, grid.nv, grid.lv);
  return masses;
}

}  // namespace weft::forces
