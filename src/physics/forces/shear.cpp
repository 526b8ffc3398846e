#include "physics/forces/shear.hpp"

#include <cmath>

namespace weft::forces {
namespace {

// s_u = Σ kAlong[k] x_k / (2 lu) and s_v = Σ kAcross[k] x_k / (2 lv) over the corners of a cell.
constexpr std::array<double, 4> kAlong{-1, 1, -1, 1};
constexpr std::array<double, 4> kAcross{-1, -1, 1, 1};

}  // namespace

Shear::Shear(const mesh::Grid& grid, Index first, const ShearParameters& parameters)
    : viscous_(parameters.viscosity > 0) {
  std::vector<Cell> cells;
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i) {
      const double lu = grid.du(i), lv = grid.dv(j), area = lu * lv;
      cells.push_back({{first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i, j + 1),
                        first + grid.index(i + 1, j + 1)},
                       lu,
                       lv,
                       0.5 * parameters.modulus * area,
                       0.5 * parameters.viscosity * area});
    }
  sizes_.reserve(cells.size());
  for (const Cell& cell : cells) sizes_.push_back({cell.lu, cell.lv});
  packs_.resize(packs_of(cells.size()));
  for (std::size_t p = 0; p < packs_.size(); ++p)
    for_each_lane(cells.size(), p, [&](std::size_t c, std::size_t lane, bool counts) {
      const Cell& cell = cells[c];
      for (std::size_t k = 0; k < 4; ++k) packs_[p].corners[k][lane] = cell.corners[k];
      packs_[p].half_u[lane] = 0.5 / cell.lu;
      packs_[p].half_v[lane] = 0.5 / cell.lv;
      packs_[p].elasticity[lane] = counts ? cell.elasticity : 0;
      packs_[p].viscosity[lane] = counts ? cell.viscosity : 0;
    });
}

template <class Body>
void Shear::for_each_cell(const Body& body) const {
  for (std::size_t c = 0; c < sizes_.size(); ++c) {
    const Cells& pack = packs_[c / 4];
    const std::size_t lane = c % 4;
    const auto& [lu, lv] = sizes_[c];
    body(Cell{{pack.corners[0][lane], pack.corners[1][lane], pack.corners[2][lane], pack.corners[3][lane]},
              lu,
              lv,
              pack.elasticity[lane],
              pack.viscosity[lane]});
  }
}

void Shear::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for_each_cell([&](const Cell& cell) { append_pairs_of(cell.corners, pairs); });
}

void Shear::attach(const solver::Assembly& assembly) {
  for (Cells& cells : packs_)
    find_pairs(cells.corners, cells.blocks, [&](Index i, Index j) { return assembly.block(i, j); });
}

Shear::Strain Shear::strain(const Cell& cell, std::span<const Vec3> x) {
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

template <class Points>
Shear::StrainLanes Shear::strain(const Cells& cells, Points x) {
  const VecLanes main = gather(x, cells.corners[3]) - gather(x, cells.corners[0]),
                 cross = gather(x, cells.corners[1]) - gather(x, cells.corners[2]);
  return {cells.half_u * (main + cross), cells.half_v * (main - cross)};
}

void Shear::partition(std::span<const Index> bounds) {
  cut_packs(
      bounds, packs_, [](const Cells& cells) { return std::span(cells.corners); }, ranges_);
}

void Shear::add(const Evaluation& at) const {
  ranges_.for_each(at.range, packs_.size(), [&](std::size_t p) {
    const Cells& cells = packs_[p];
    const StrainLanes s = strain(cells, at.x);
    const Lanes c = dot(s.su, s.sv);
    Lanes stress = cells.elasticity * c;
    if (viscous_) {
      const auto strain_at = [&](std::span<const Vec3> x) {
        const StrainLanes of_then = strain(cells, x);
        return dot(of_then.su, of_then.sv);
      };
      const auto by_velocity = [&] {
        const StrainLanes rate = strain(cells, at.v);
        return dot(rate.su, s.sv) + dot(s.su, rate.sv);
      };
      stress += cells.viscosity * at.rate_of(c, strain_at, by_velocity);
    }
    // The force on corner k is −stress × ∂c/∂x_k. `main` is stress × ∂c/∂x of corner 3, and `cross`
    // that of corner 1. The force on corner 0 is opposite to that on corner 3, and the force on
    // corner 2 to that on corner 1.
    const VecLanes u_part = stress * cells.half_u * s.sv, v_part = stress * cells.half_v * s.su;
    const VecLanes main = u_part + v_part, cross = u_part - v_part;
    forces::add(at.force, cells.corners[0], main);
    subtract(at.force, cells.corners[3], main);
    subtract(at.force, cells.corners[1], cross);
    forces::add(at.force, cells.corners[2], cross);
    if (at.assembly) add_stiffness(cells, s, c, at);
  });
}

// The second derivative of c = ⟨s_u, s_v⟩ is ½ (‖δs_u + δs_v‖² − ‖δs_u − δs_v‖²). After
// multiplication by the elastic stress, one of these squares is positive and one negative. The
// matrix contains only the positive one, so that it stays positive semidefinite. The derivatives at
// opposite corners differ only in sign, so that the six pairs need only four different blocks, up
// to their sign.
void Shear::add_stiffness(const Cells& cells, const StrainLanes& s, const Lanes& c, const Evaluation& at) {
  const Lanes sign = c < 0 ? lanes_of(-1) : lanes_of(1), curvature = 0.5 * cells.elasticity * abs(c);
  const Lanes size = cells.elasticity + at.rate * cells.viscosity;
  // ∂c/∂x is `main` at corner 3, −`main` at corner 0, `cross` at corner 1, and −`cross` at corner 2. Likewise,
  // `main_half` and `cross_half` are the weights of corners 3 and 1 in the positive square.
  const VecLanes u_part = cells.half_u * s.sv, v_part = cells.half_v * s.su;
  const VecLanes main = u_part + v_part, cross = u_part - v_part;
  const Lanes main_half = cells.half_u + sign * cells.half_v, cross_half = cells.half_u - sign * cells.half_v;
  const VecLanes of_main = size * main, of_cross = size * cross;
  const Lanes both = curvature * main_half * cross_half;
  const auto mm = packed(outer(of_main, main, curvature * main_half * main_half));
  const auto mc = packed(outer(of_main, cross, both)), cm = packed(outer(of_cross, main, both));
  const auto cc = packed(outer(of_cross, cross, curvature * cross_half * cross_half));
  for (std::size_t l = 0; l < 4; ++l) {
    at.assembly.add(cells.blocks[0][l], -mc[l]);
    at.assembly.add(cells.blocks[1][l], mc[l]);
    at.assembly.add(cells.blocks[2][l], -mm[l]);
    at.assembly.add(cells.blocks[3][l], -cc[l]);
    at.assembly.add(cells.blocks[4][l], cm[l]);
    at.assembly.add(cells.blocks[5][l], -cm[l]);
  }
}

void Shear::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                         solver::BlockMatrix& jacobian) const {
  for_each_cell([&](const Cell& cell) {
    const Strain s = strain(cell, x), w = strain(cell, v);
    std::array<Vec3, 4> gradient, rate_gradient;  // ∂c/∂x_k, ∂ċ/∂x_k
    for (std::size_t k = 0; k < 4; ++k) {
      gradient[k] = kAlong[k] / (2 * cell.lu) * s.sv + kAcross[k] / (2 * cell.lv) * s.su;
      rate_gradient[k] = kAlong[k] / (2 * cell.lu) * w.sv + kAcross[k] / (2 * cell.lv) * w.su;
    }
    const double stress = cell.elasticity * s.c + cell.viscosity * (w.su.dot(s.sv) + s.su.dot(w.sv));
    const double outer = cell.elasticity + rate * cell.viscosity;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        // Second derivative of c: δ²c = 2 ⟨δs_u, δs_v⟩.
        const double second = (kAlong[a] * kAcross[b] + kAcross[a] * kAlong[b]) / (4 * cell.lu * cell.lv);
        jacobian.add(jacobian.slot(cell.corners[a], cell.corners[b]),
                     outer * gradient[a] * gradient[b].transpose() +
                         cell.viscosity * gradient[a] * rate_gradient[b].transpose() +
                         stress * second * Mat3::Identity());
      }
    }
  });
}

double Shear::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for_each_cell([&](const Cell& cell) {
    const double c = strain(cell, x).c;
    sum += 0.5 * cell.elasticity * c * c;
  });
  return sum;
}

}  // namespace weft::forces
