#include "forces/shear.hpp"

#include <cmath>

namespace weft::forces {
namespace {

// s_u = Σ kAlong[k] x_k / 2l_u and s_v = Σ kAcross[k] x_k / 2l_v over the corners of a cell.
constexpr std::array<double, 4> kAlong{-1, 1, -1, 1};
constexpr std::array<double, 4> kAcross{-1, -1, 1, 1};

}  // namespace

Shear::Shear(const mesh::Grid& grid, Index first, const ShearParameters& parameters) {
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i) {
      const double lu = grid.du(i), lv = grid.dv(j), area = lu * lv;
      cells_.push_back({{first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i, j + 1),
                         first + grid.index(i + 1, j + 1)},
                        lu,
                        lv,
                        0.5 * parameters.modulus * area,
                        0.5 * parameters.viscosity * area});
    }
}

void Shear::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Cell& cell : cells_)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) pairs.emplace_back(cell.corners[a], cell.corners[b]);
}

void Shear::attach(const solver::BlockMatrix& matrix) {
  slots_.resize(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) slots_[c][4 * a + b] = matrix.slot(cells_[c].corners[a], cells_[c].corners[b]);
}

Shear::Strain Shear::strain(const Cell& cell, std::span<const Vec3> x) const {
  const Vec3& x00 = x[cell.corners[0]];
  const Vec3& x10 = x[cell.corners[1]];
  const Vec3& x01 = x[cell.corners[2]];
  const Vec3& x11 = x[cell.corners[3]];
  Strain s;
  s.su = (x10 - x00 + x11 - x01) / (2 * cell.lu);
  s.sv = (x01 - x00 + x11 - x10) / (2 * cell.lv);
  s.c = s.su.dot(s.sv);
  return s;
}

void Shear::add(const Evaluation& at) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Cell& cell = cells_[c];
    const Strain s = strain(cell, at.x);
    const Strain rate = strain(cell, at.v);
    const double strain_rate = rate.su.dot(s.sv) + s.su.dot(rate.sv);
    const double stress = cell.elasticity * s.c + cell.viscosity * strain_rate;
    // ∂c/∂x_k; opposite corners get opposite signs, so two vectors serve all four.
    const Vec3 u_part = s.sv / (2 * cell.lu), v_part = s.su / (2 * cell.lv);
    const Vec3 main_diagonal = stress * (u_part + v_part), cross_diagonal = stress * (u_part - v_part);
    at.force[cell.corners[0]] += main_diagonal;
    at.force[cell.corners[3]] -= main_diagonal;
    at.force[cell.corners[1]] -= cross_diagonal;
    at.force[cell.corners[2]] += cross_diagonal;
    if (at.matrix != nullptr) add_stiffness(c, s, rate, at);
  }
}

void Shear::add_stiffness(std::size_t index, const Strain& s, const Strain& rate, const Evaluation& at) const {
  if (at.linearisation == Linearisation::exact)
    add_exact_stiffness(index, s, rate, at);
  else
    add_definite_stiffness(index, s, at);
}

void Shear::add_exact_stiffness(std::size_t index, const Strain& s, const Strain& rate, const Evaluation& at) const {
  const Cell& cell = cells_[index];
  std::array<Vec3, 4> gradient;       // ∂c/∂x_k
  std::array<Vec3, 4> rate_gradient;  // ∂ċ/∂x_k
  for (int k = 0; k < 4; ++k) {
    gradient[k] = kAlong[k] / (2 * cell.lu) * s.sv + kAcross[k] / (2 * cell.lv) * s.su;
    rate_gradient[k] = kAlong[k] / (2 * cell.lu) * rate.sv + kAcross[k] / (2 * cell.lv) * rate.su;
  }
  const double stress = cell.elasticity * s.c + cell.viscosity * (rate.su.dot(s.sv) + s.su.dot(rate.sv));
  const double outer = cell.elasticity + at.rate * cell.viscosity;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      // Second derivative of c: δ²c = 2 ⟨δs_u, δs_v⟩.
      const double second = (kAlong[a] * kAcross[b] + kAcross[a] * kAlong[b]) / (4 * cell.lu * cell.lv);
      at.matrix->add(slots_[index][4 * a + b], outer * gradient[a] * gradient[b].transpose() +
                                                   cell.viscosity * gradient[a] * rate_gradient[b].transpose() +
                                                   stress * second * Mat3::Identity());
    }
  }
}

// Of the second derivative, ½ (‖δs_u + δs_v‖² − ‖δs_u − δs_v‖²), the definite form keeps the half whose sign agrees
// with the stress. Opposite corners have opposite derivatives, so three blocks, with signs, serve all sixteen pairs:
// four times as fast as one by one.
void Shear::add_definite_stiffness(std::size_t index, const Strain& s, const Evaluation& at) const {
  const Cell& cell = cells_[index];
  const double sign = s.c < 0 ? -1 : 1, curvature = 0.5 * cell.elasticity * std::abs(s.c);
  const double outer = cell.elasticity + at.rate * cell.viscosity;
  // ∂c/∂x of corners 3 and 1; that of 0 is minus the first, that of 2 minus the second. And so for the half kept.
  const Vec3 main = s.sv / (2 * cell.lu) + s.su / (2 * cell.lv), cross = s.sv / (2 * cell.lu) - s.su / (2 * cell.lv);
  const double main_half = 1 / (2 * cell.lu) + sign / (2 * cell.lv),
               cross_half = 1 / (2 * cell.lu) - sign / (2 * cell.lv);
  const auto block = [&](const Vec3& a, double half_a, const Vec3& b, double half_b) -> Mat3 {
    return outer * a * b.transpose() + curvature * half_a * half_b * Mat3::Identity();
  };
  const Mat3 mm = block(main, main_half, main, main_half), cc = block(cross, cross_half, cross, cross_half);
  const Mat3 mc = block(main, main_half, cross, cross_half), cm = mc.transpose();
  const auto add = [&](int a, int b, const Mat3& k) { at.matrix->add(slots_[index][4 * a + b], k); };
  const auto subtract = [&](int a, int b, const Mat3& k) { at.matrix->subtract(slots_[index][4 * a + b], k); };
  add(0, 0, mm), subtract(0, 1, mc), add(0, 2, mc), subtract(0, 3, mm);
  subtract(1, 0, cm), add(1, 1, cc), subtract(1, 2, cc), add(1, 3, cm);
  add(2, 0, cm), subtract(2, 1, cc), add(2, 2, cc), subtract(2, 3, cm);
  subtract(3, 0, mm), add(3, 1, mc), subtract(3, 2, mc), add(3, 3, mm);
}

double Shear::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Cell& cell : cells_) {
    const double c = strain(cell, x).c;
    sum += 0.5 * cell.elasticity * c * c;
  }
  return sum;
}

}  // namespace weft::forces
