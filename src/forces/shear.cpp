#include "forces/shear.hpp"

#include <cmath>

namespace weft::forces {
namespace {

// s_u = Σ kAlong[k] x_k / 2l_u and s_v = Σ kAcross[k] x_k / 2l_v over the corners of a cell.
constexpr std::array<double, 4> kAlong{-1, 1, -1, 1};
constexpr std::array<double, 4> kAcross{-1, -1, 1, 1};

}  // namespace

Shear::Shear(const mesh::Grid& grid, Index first, const ShearParameters& parameters) : lu_(grid.lu), lv_(grid.lv) {
  const double area = lu_ * lv_;
  elasticity_ = 0.5 * parameters.modulus * area;
  viscosity_ = 0.5 * parameters.viscosity * area;
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i)
      cells_.push_back({first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i, j + 1),
                        first + grid.index(i + 1, j + 1)});
}

void Shear::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Cell& cell : cells_)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) pairs.emplace_back(cell[a], cell[b]);
}

void Shear::attach(const solver::BlockMatrix& matrix) {
  slots_.resize(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) slots_[c][4 * a + b] = matrix.slot(cells_[c][a], cells_[c][b]);
}

Shear::Strain Shear::strain(const Cell& cell, std::span<const Vec3> x) const {
  const Vec3& x00 = x[static_cast<std::size_t>(cell[0])];
  const Vec3& x10 = x[static_cast<std::size_t>(cell[1])];
  const Vec3& x01 = x[static_cast<std::size_t>(cell[2])];
  const Vec3& x11 = x[static_cast<std::size_t>(cell[3])];
  Strain s;
  s.su = (x10 - x00 + x11 - x01) / (2 * lu_);
  s.sv = (x01 - x00 + x11 - x10) / (2 * lv_);
  s.c = s.su.dot(s.sv);
  return s;
}

void Shear::add(const Evaluation& at) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Strain s = strain(cells_[c], at.x);
    const Strain rate = strain(cells_[c], at.v);
    const double strain_rate = rate.su.dot(s.sv) + s.su.dot(rate.sv);
    const double stress = elasticity_ * s.c + viscosity_ * strain_rate;
    // ∂c/∂x_k; opposite corners get opposite signs, so two vectors serve all four.
    const Vec3 u_part = s.sv / (2 * lu_), v_part = s.su / (2 * lv_);
    const Vec3 main_diagonal = stress * (u_part + v_part), cross_diagonal = stress * (u_part - v_part);
    at.force[static_cast<std::size_t>(cells_[c][0])] += main_diagonal;
    at.force[static_cast<std::size_t>(cells_[c][3])] -= main_diagonal;
    at.force[static_cast<std::size_t>(cells_[c][1])] -= cross_diagonal;
    at.force[static_cast<std::size_t>(cells_[c][2])] += cross_diagonal;
    if (at.matrix != nullptr) add_stiffness(c, s, rate, at);
  }
}

void Shear::add_stiffness(std::size_t cell, const Strain& s, const Strain& rate, const Evaluation& at) const {
  if (at.linearisation == Linearisation::exact)
    add_exact_stiffness(cell, s, rate, at);
  else
    add_definite_stiffness(cell, s, at);
}

void Shear::add_exact_stiffness(std::size_t cell, const Strain& s, const Strain& rate, const Evaluation& at) const {
  std::array<Vec3, 4> gradient;       // ∂c/∂x_k
  std::array<Vec3, 4> rate_gradient;  // ∂ċ/∂x_k
  for (int k = 0; k < 4; ++k) {
    gradient[k] = kAlong[k] / (2 * lu_) * s.sv + kAcross[k] / (2 * lv_) * s.su;
    rate_gradient[k] = kAlong[k] / (2 * lu_) * rate.sv + kAcross[k] / (2 * lv_) * rate.su;
  }
  const double stress = elasticity_ * s.c + viscosity_ * (rate.su.dot(s.sv) + s.su.dot(rate.sv));
  const double outer = elasticity_ + at.rate * viscosity_;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      // Second derivative of c: δ²c = 2 ⟨δs_u, δs_v⟩.
      const double second = (kAlong[a] * kAcross[b] + kAcross[a] * kAlong[b]) / (4 * lu_ * lv_);
      at.matrix->add(slots_[cell][4 * a + b], outer * gradient[a] * gradient[b].transpose() +
                                                  viscosity_ * gradient[a] * rate_gradient[b].transpose() +
                                                  stress * second * Mat3::Identity());
    }
  }
}

// Of the second derivative, ½ (‖δs_u + δs_v‖² − ‖δs_u − δs_v‖²), the definite form keeps the half whose sign agrees
// with the stress. Opposite corners have opposite derivatives, so three blocks, with signs, serve all sixteen pairs:
// four times as fast as one by one.
void Shear::add_definite_stiffness(std::size_t cell, const Strain& s, const Evaluation& at) const {
  const double sign = s.c < 0 ? -1 : 1, curvature = 0.5 * elasticity_ * std::abs(s.c);
  const double outer = elasticity_ + at.rate * viscosity_;
  // ∂c/∂x of corners 3 and 1; that of 0 is minus the first, that of 2 minus the second. And so for the half kept.
  const Vec3 main = s.sv / (2 * lu_) + s.su / (2 * lv_), cross = s.sv / (2 * lu_) - s.su / (2 * lv_);
  const double main_half = 1 / (2 * lu_) + sign / (2 * lv_), cross_half = 1 / (2 * lu_) - sign / (2 * lv_);
  const auto block = [&](const Vec3& a, double half_a, const Vec3& b, double half_b) -> Mat3 {
    return outer * a * b.transpose() + curvature * half_a * half_b * Mat3::Identity();
  };
  const Mat3 mm = block(main, main_half, main, main_half), cc = block(cross, cross_half, cross, cross_half);
  const Mat3 mc = block(main, main_half, cross, cross_half), cm = mc.transpose();
  const auto add = [&](int a, int b, const Mat3& k) { at.matrix->add(slots_[cell][4 * a + b], k); };
  const auto subtract = [&](int a, int b, const Mat3& k) { at.matrix->subtract(slots_[cell][4 * a + b], k); };
  add(0, 0, mm), subtract(0, 1, mc), add(0, 2, mc), subtract(0, 3, mm);
  subtract(1, 0, cm), add(1, 1, cc), subtract(1, 2, cc), add(1, 3, cm);
  add(2, 0, cm), subtract(2, 1, cc), add(2, 2, cc), subtract(2, 3, cm);
  subtract(3, 0, mm), add(3, 1, mc), subtract(3, 2, mc), add(3, 3, mm);
}

double Shear::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Cell& cell : cells_) {
    const double c = strain(cell, x).c;
    sum += 0.5 * elasticity_ * c * c;
  }
  return sum;
}

}  // namespace weft::forces
