#include "forces/stretch.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {

Stretch::Stretch(const mesh::Grid& grid, Index first, const StretchParameters& parameters) : first_(first) {
  const auto add_edge = [&](Index i, Index j, double l, double width, double k) {
    const double per_length_sq = width * l / (l * l);  // A / l²
    edges_.push_back({first + i, first + j, l, k * per_length_sq, parameters.viscosity * per_length_sq});
  };
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      if (i + 1 < grid.nu)
        add_edge(grid.index(i, j), grid.index(i + 1, j), grid.du(i), grid.width_v(j), parameters.weft);
      if (j + 1 < grid.nv)
        add_edge(grid.index(i, j), grid.index(i, j + 1), grid.dv(j), grid.width_u(i), parameters.warp);
    }
  }
}

void Stretch::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Edge& edge : edges_) pairs.emplace_back(edge.i, edge.j);
}

void Stretch::attach(const solver::BlockMatrix& matrix) {
  slots_.clear();
  for (const Edge& e : edges_)
    slots_.push_back({matrix.diagonal(e.i), matrix.diagonal(e.j), matrix.slot(e.i, e.j), matrix.slot(e.j, e.i)});
}

// ∂f_i/∂x_j + rate ∂f_i/∂v_j for the force on i.
Mat3 Stretch::stiffness(const Edge& edge, const Vec3& n, double length, const Vec3& relative_velocity,
                        const Evaluation& at) const {
  const Mat3 along = n * n.transpose();
  const Mat3 across = Mat3::Identity() - along;
  // Across the edge the tension stiffens a stretched edge and, as compression, softens a short one. The absolute-
  // value projection takes its modulus (Chen, Liu, Levin, Zheng & Jacobson, "Stabler Neo-Hookean Simulation: Absolute
  // Eigenvalue Filtering for Projected Newton", 2024), but no more than the stiffness along the edge.
  double lateral = 1 - edge.rest_length / length;
  if (at.linearisation == Linearisation::definite) lateral = std::max(lateral, 0.0);
  if (at.linearisation == Linearisation::abs_projected) lateral = std::min(std::abs(lateral), 1.0);
  Mat3 k = (edge.elasticity + at.rate * edge.viscosity) * along + (edge.elasticity * lateral) * across;
  if (at.linearisation == Linearisation::exact && edge.viscosity > 0) {
    // d/dd of (n·w) n: the direction turns with the edge. Unsymmetric, and O(η‖w‖/l), so the definite form does
    // without it: the residual stays exact, Newton then converges linearly in that small part.
    k += edge.viscosity / length * (n * (across * relative_velocity).transpose() + n.dot(relative_velocity) * across);
  }
  return k;
}

void Stretch::add(const Evaluation& at) const {
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const auto i = static_cast<std::size_t>(edge.i), j = static_cast<std::size_t>(edge.j);
    const Vec3 d = at.x[j] - at.x[i];
    const Vec3 w = at.v[j] - at.v[i];
    // A collapsed edge has no direction: it then pulls nowhere, and a tiny length keeps the matrix finite.
    const double length = std::max(d.norm(), 1e-12 * edge.rest_length);
    const Vec3 n = d / length;
    const Vec3 f = (edge.elasticity * (length - edge.rest_length) + edge.viscosity * n.dot(w)) * n;
    at.force[i] += f;
    at.force[j] -= f;
    if (at.matrix == nullptr) continue;

    const Mat3 k = stiffness(edge, n, length, w, at);
    at.matrix->add(slots_[e].ii, k);
    at.matrix->add(slots_[e].jj, k);
    at.matrix->subtract(slots_[e].ij, k);
    at.matrix->subtract(slots_[e].ji, k);
  }
}

double Stretch::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Edge& e : edges_) {
    const double extension =
        (x[static_cast<std::size_t>(e.j)] - x[static_cast<std::size_t>(e.i)]).norm() - e.rest_length;
    sum += 0.5 * e.elasticity * extension * extension;
  }
  return sum;
}

double Stretch::max_strain(std::span<const Vec3> x) const {
  double largest = 0;
  for (const Edge& e : edges_) {
    const double length = (x[static_cast<std::size_t>(e.j)] - x[static_cast<std::size_t>(e.i)]).norm();
    largest = std::max(largest, std::abs(length / e.rest_length - 1));
  }
  return largest;
}

void Stretch::strain_per_particle(std::span<const Vec3> x, std::span<float> heat) const {
  for (const Edge& e : edges_) {
    const double length = (x[static_cast<std::size_t>(e.j)] - x[static_cast<std::size_t>(e.i)]).norm();
    const auto strain = static_cast<float>(std::abs(length / e.rest_length - 1));
    for (Index p : {e.i, e.j}) {
      float& value = heat[static_cast<std::size_t>(p - first_)];
      value = std::max(value, strain);
    }
  }
}

}  // namespace weft::forces
