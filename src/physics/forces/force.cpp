#include "physics/forces/force.hpp"

#include <algorithm>

namespace weft::forces {

void append_pairs_of(std::span<const Index> particles, std::vector<std::pair<Index, Index>>& pairs) {
  for (std::size_t a = 0; a < particles.size(); ++a)
    for (std::size_t b = a + 1; b < particles.size(); ++b) pairs.emplace_back(particles[a], particles[b]);
}

Mat3 spring_stiffness(const Vec3& d, const Vec3& w, double rest_length, double elasticity, double viscosity,
                      double rate) {
  const double length = std::max(d.norm(), kMinStretch * rest_length);
  const Vec3 n = d / length;
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  return (elasticity + rate * viscosity) * along + elasticity * (1 - rest_length / length) * across +
         viscosity / length * (n * (across * w).transpose() + n.dot(w) * across);
}

double Membrane::max_strain(std::span<const Vec3> x) const {
  double largest = 0;
  for_each_strain(x, [&](double strain, std::span<const Index>) { largest = std::max(largest, strain); });
  return largest;
}

void Membrane::strain_per_particle(std::span<const Vec3> x, std::span<float> strains) const {
  for_each_strain(x, [&](double strain, std::span<const Index> particles) {
    for (const Index p : particles) {
      float& value = strains[at(p - first_)];
      value = std::max(value, static_cast<float>(strain));
    }
  });
}

std::vector<double> lumped_masses(const mesh::Grid& grid, double density) {
  std::vector<double> masses(static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) masses[grid.index(i, j)] = density * grid.width_u(i) * grid.width_v(j);
  return masses;
}

std::vector<double> lumped_masses(const mesh::Sheet& sheet, double density) {
  std::vector<double> masses(sheet.rest.size());
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const double own = sheet.reinforcements.empty() ? density : density * sheet.reinforcements[t].density;
    for (Index i : sheet.triangles[t]) masses[i] += own * mesh::rest_area(sheet, t) / 3;
  }
  for (const mesh::Band& band : sheet.bands)
    for (std::size_t k = 0; k < band.lengths.size(); ++k)
      for (Index i : {band.vertices[k], band.vertices[k + 1]})
        masses[i] += 0.5 * (band.mass + density * band.allowance) * band.lengths[k];
  return masses;
}

}  // namespace weft::forces
