#include "physics/forces/crossed_membrane.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {

using solver::packed_outer;
using solver::packed_scalar;
using solver::PackedBlock;

namespace {

// θ: fraction of ⟨g²⟩ that enters the lengths. With θ = 1, a cell that bends along one direction
// tends to become narrower along the other direction; its neighbours and clamps resist this.
// (Measured: errors of the tip position of a cantilever of 16 cells, with stretch stiffnesses of
// 1e4, 1e5 and 1e6 N/m. θ = 1: −0.7, −3.5 and −8.1 %; 1/4: 0.1, −0.5 and −2.8 %; 1/10: 0.2, 0.1 and
// −0.8 %.) With a smaller θ, tension flattens cells less.
constexpr double kHeightFraction = 0.1;
// S₀ relative to ‖D₁ × D₂‖ of the cell at rest. The smaller ‖D₁ × D₂‖ is, the faster the normal
// D₁ × D₂ / ‖D₁ × D₂‖ turns; in folded cells it turns too fast to be a reference for the height of
// the middle (measured: with 0.1, leather that a pin pulls needs steps of 1 µs).
constexpr double kFoldedSize = 0.5;

// Indices of the corners of triangle k among the five particles of a cell.
std::array<std::size_t, 3> corners_of(std::size_t k) {
  return {k, (k + 1) % 4, 4};
}

// Weights of the corners in the twist; the middle has none.
constexpr std::array<double, 5> kTwist{1, -1, 1, -1, 0};

// See CrossedMembrane::Lateral. clamped_lateral() is never negative, so that the matrix is positive semidefinite (as in
// Stretch).
double exact_lateral(double length) {
  return 1 - 1 / length;
}
double clamped_lateral(double length) {
  return std::max(exact_lateral(length), 0.0);
}

}  // namespace

CrossedMembrane::CrossedMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                                 const ShearParameters& shear)
    : TriangleMembrane(sheet, first, stretch, shear) {
  const std::span<const Element> triangles = elements();
  for (std::size_t t = 0; t < triangles.size(); t += 4) {
    Cell cell{};
    for (std::size_t k = 0; k < 4; ++k) {
      cell.particles[k] = triangles[t + k].particles[0];
      const Vec2& of_middle = triangles[t + k].gradients[2];
      cell.height_weight += kHeightFraction * 0.25 * of_middle.cwiseAbs2();
      cell.min_size += 2 * kFoldedSize * triangles[t + k].area;
    }
    cell.particles[4] = triangles[t].particles[2];
    cells_.push_back(cell);
  }
}

void CrossedMembrane::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Cell& cell : cells_) append_pairs_of(cell.particles, pairs);
}

void CrossedMembrane::attach(const solver::Assembly& assembly) {
  cell_blocks_.resize(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto& particles = cells_[c].particles;
    for (std::size_t a = 0; a < 5; ++a)
      for (std::size_t b = 0; b < 5; ++b)
        if (particles[a] < particles[b]) cell_blocks_[c][5 * a + b] = assembly.block(particles[a], particles[b]);
  }
}

template <class Vectors>
CrossedMembrane::CellVectors CrossedMembrane::vectors_of(const Cell& cell, const Vectors& of) {
  CellVectors vectors;
  for (std::size_t k = 0; k < 5; ++k) vectors[k] = solver::vec3_of(of[cell.particles[k]]);
  return vectors;
}

CrossedMembrane::State CrossedMembrane::state_of(const Cell& cell, const CellVectors& positions) {
  State state;
  state.flat = positions;
  const auto& [a, b, c, d, middle] = state.flat;
  state.diagonals = {c - a, d - b};
  // Differences of positions keep the rounding error independent of the distance from the origin.
  state.middle_offset = (middle - a) - 0.25 * ((b - a) + (c - a) + (d - a));
  const Vec3 product = state.diagonals[0].cross(state.diagonals[1]);
  const double size = product.norm(), min_size = cell.min_size;
  const bool is_folded = size < min_size;
  state.size = is_folded ? 0.5 * (size * size / min_size + min_size) : size;
  state.normal = product / state.size;
  if (size > 0) state.direction = product / size;
  state.kept_change = is_folded ? 1 - size * size / (min_size * state.size) : 0;
  state.height = state.normal.dot(state.middle_offset);
  state.flat[4] -= state.height * state.normal;
  state.twist = (a - b) + (c - d);
  state.skew = state.normal.squaredNorm() * state.twist.squaredNorm();
  return state;
}

// δn = (I − (1 − κ) e eᵀ) `product` / S, where `product` is δ(D₁ × D₂). The matrix is symmetric, so that pull_back()
// can use this function, too.
Vec3 CrossedMembrane::normal_change(const State& state, const Vec3& product) {
  return (product - (1 - state.kept_change) * state.direction.dot(product) * state.direction) / state.size;
}

// Converts forces on State::flat (`force`), on the height w and on the skew q to forces on the
// particles, which replace those in `force`. o is middle_offset:
//
//     δm' = δm − n δw − w δn,   δw = n·δo + o·δn,   δq = 2 ‖n‖² t·δt + 2 ‖t‖² n·δn,
//     δ(D₁ × D₂) = δD₁ × D₂ + D₁ × δD₂.
void CrossedMembrane::pull_back(const State& state, CellVectors& force, double along_height, double along_skew) {
  const auto& [d1, d2] = state.diagonals;
  const Vec3 &n = state.normal, &t = state.twist;
  const double along = along_height - force[4].dot(n);
  const Vec3 turn = normal_change(
      state, along * state.middle_offset - state.height * force[4] + 2 * along_skew * t.squaredNorm() * n);
  const Vec3 on_d1 = d2.cross(turn), on_d2 = turn.cross(d1), corner_share = 0.25 * along * n;
  const Vec3 on_twist = 2 * along_skew * n.squaredNorm() * t;
  force[0] -= on_d1 + corner_share - on_twist;
  force[1] -= on_d2 + corner_share + on_twist;
  force[2] += on_d1 - corner_share + on_twist;
  force[3] += on_d2 - corner_share - on_twist;
  force[4] += along * n;
}

// The transpose of pull_back: converts the velocities of the particles in `flat` to the rates of
// State::flat, of the height and of the skew.
void CrossedMembrane::push_forward(const State& state, CellVectors& flat, double& height, double& skew) {
  const Vec3 middle_offset = flat[4] - 0.25 * (flat[0] + flat[1] + flat[2] + flat[3]);
  const Vec3 twist = (flat[0] - flat[1]) + (flat[2] - flat[3]);
  const auto& [d1, d2] = state.diagonals;
  const Vec3 &n = state.normal, &t = state.twist;
  const Vec3 turn = normal_change(state, (flat[2] - flat[0]).cross(d2) + d1.cross(flat[3] - flat[1]));
  height = n.dot(middle_offset) + turn.dot(state.middle_offset);
  skew = 2 * (n.squaredNorm() * t.dot(twist) + t.squaredNorm() * n.dot(turn));
  flat[4] -= height * n + state.height * turn;
}

void CrossedMembrane::partition(std::span<const Index> bounds) {
  ranges_.partition(bounds, cells_.size(), [&](std::size_t c, const auto& visit) {
    for (Index particle : cells_[c].particles) visit(particle);
  });
}

void CrossedMembrane::add(const Evaluation& at) const {
  const bool viscous = stretch_.viscosity > 0 || shear_.viscosity > 0;
  ranges_.for_each(at.range, cells_.size(), [&](std::size_t c) {
    const Cell& cell = cells_[c];
    const State state = state_of(cell, vectors_of(cell, at.x));
    CellVectors rate, force;
    double height_rate = 0, skew_rate = 0, along_height = 0, along_skew = 0;
    rate.fill(Vec3::Zero()), force.fill(Vec3::Zero());
    if (viscous) {
      rate = vectors_of(cell, at.v);
      push_forward(state, rate, height_rate, skew_rate);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Element& element = elements()[4 * c + k];
      const Gradient s = gradient_of(element, state.flat, k), s_rate = gradient_of(element, rate, k);
      const CellWeights cell_weights = cell_weights_of(cell, element);
      const Vec2 length = lengths_of(s, cell_weights, state);
      const Vec2 added_rate =
          state.height * height_rate * cell_weights.of_height + 0.5 * skew_rate * cell_weights.of_skew;
      const double u = length.x(), v = length.y();
      Vec3 strain_rate = Vec3::Zero();
      if (viscous)
        strain_rate = at.rate_of(
            Vec3(u, v, s.u.dot(s.v)),
            [&](std::span<const Vec3> x) { return strains_of(c, k, state_of(cell, vectors_of(cell, x))); },
            [&] {
              return Vec3((s.u.dot(s_rate.u) + added_rate.x()) / u, (s.v.dot(s_rate.v) + added_rate.y()) / v,
                          s_rate.u.dot(s.v) + s.u.dot(s_rate.v));
            });
      const double weft = (stretch_.weft * (u - 1) + stretch_.viscosity * strain_rate[0]) / u;
      const double warp = (stretch_.warp * (v - 1) + stretch_.viscosity * strain_rate[1]) / v;
      const double stress = 0.5 * (shear_.modulus * s.u.dot(s.v) + shear_.viscosity * strain_rate[2]);
      const Vec3 along_u = element.area * (weft * s.u + stress * s.v);
      const Vec3 along_v = element.area * (warp * s.v + stress * s.u);
      for (std::size_t i = 0; i < 3; ++i)
        force[corners_of(k)[i]] -= element.gradients[i].x() * along_u + element.gradients[i].y() * along_v;
      along_height -= element.area * state.height * cell_weights.of_height.dot(Vec2(weft, warp));
      along_skew -= element.area * 0.5 * cell_weights.of_skew.dot(Vec2(weft, warp));
    }
    pull_back(state, force, along_height, along_skew);
    for (std::size_t i = 0; i < 5; ++i) at.force.add(cell.particles[i], solver::padded<double>(force[i]));
    if (!at.assembly) return;
    const Blocks blocks = blocks_of(c, state, at.rate, clamped_lateral, true);
    for (std::size_t a = 0; a < 5; ++a)
      for (std::size_t b = 0; b < 5; ++b)
        if (cell.particles[a] < cell.particles[b]) at.assembly.add(cell_blocks_[c][5 * a + b], blocks[5 * a + b]);
  });
}

void CrossedMembrane::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> /*v*/, double rate,
                                   solver::BlockMatrix& jacobian) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto& particles = cells_[c].particles;
    const Blocks blocks = blocks_of(c, state_of(cells_[c], vectors_of(cells_[c], x)), rate, exact_lateral, false);
    for (std::size_t a = 0; a < 5; ++a)
      for (std::size_t b = 0; b < 5; ++b) jacobian.add(jacobian.slot(particles[a], particles[b]), blocks[5 * a + b]);
  }
}

TriangleMembrane::Gradient CrossedMembrane::gradient_of(const Element& element, const CellVectors& flat,
                                                        std::size_t k) {
  return gradient(element, flat[k], flat[(k + 1) % 4], flat[4]);
}

CrossedMembrane::CellWeights CrossedMembrane::cell_weights_of(const Cell& cell, const Element& element) {
  return {cell.height_weight, element.gradients[2].cwiseAbs2() / 16};
}

// Length / rest length of a triangle's threads, including the terms of the cell's height and skew.
Vec2 CrossedMembrane::lengths_of(const Gradient& s, const CellWeights& cell_weights, const State& state) {
  const Vec2 added = state.height * state.height * cell_weights.of_height + state.skew * cell_weights.of_skew;
  return (Vec2(s.u.squaredNorm(), s.v.squaredNorm()) + added).cwiseSqrt().cwiseMax(kMinStretch);
}

Vec3 CrossedMembrane::strains_of(std::size_t c, std::size_t k, const State& state) const {
  const Element& element = elements()[4 * c + k];
  const Gradient s = gradient_of(element, state.flat, k);
  const Vec2 length = lengths_of(s, cell_weights_of(cells_[c], element), state);
  return {length.x(), length.y(), s.u.dot(s.v)};
}

// Sums (k (1 − lateral) + rate η) ∂L ∂Lᵀ over the ratios L of length to rest length, with the stretch stiffness k and
// the viscosity η, and the same for shear without `lateral`. Then adds the geometric stiffness
// (that of the elastic stresses). Perpendicular to n, it is computed from the gradients of
// State::flat. Along n, it is computed from those of a cell with its middle at the mean of the
// corners (if ‖n‖ = 1), plus the stiffness of the height. The stiffness of the twist acts in all
// directions. If `definite`, the part of the shear stress is made positive semidefinite, as in Shear.
CrossedMembrane::Blocks CrossedMembrane::blocks_of(std::size_t c, const State& state, double rate, Lateral lateral_of,
                                                   bool definite) const {
  const Cell& cell = cells_[c];
  const Vec3& n = state.normal;
  const double w = state.height, n_sq = n.squaredNorm();
  Blocks sum;
  sum.fill(packed_scalar(0));
  std::array<double, 25> across{}, along{};
  double of_height = 0, of_twist = 0;
  const auto add_outer = [&](double size, CellVectors slope, double along_height, double along_skew) {
    pull_back(state, slope, along_height, along_skew);
    for (std::size_t a = 0; a < 5; ++a) {
      const Vec3 scaled = size * slope[a];
      for (std::size_t b = 0; b < 5; ++b) sum[5 * a + b] = sum[5 * a + b] + packed_outer(scaled, slope[b]);
    }
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const Element& element = elements()[4 * c + k];
    const Gradient s = gradient_of(element, state.flat, k);
    const CellWeights cell_weights = cell_weights_of(cell, element);
    const Vec2 length = lengths_of(s, cell_weights, state);
    const double u = length.x(), v = length.y();
    const double lateral_u = lateral_of(u), lateral_v = lateral_of(v);
    CellVectors of_u, of_v, of_shear;
    of_u.fill(Vec3::Zero()), of_v = of_shear = of_u;
    std::array<Vec2, 5> flat{}, normal_gradients{};
    flat.fill(Vec2::Zero()), normal_gradients.fill(Vec2::Zero());
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2& g = element.gradients[i];
      const std::size_t p = corners_of(k)[i];
      of_u[p] = g.x() / u * s.u;
      of_v[p] = g.y() / v * s.v;
      of_shear[p] = g.x() * s.v + g.y() * s.u;
      flat[p] = g;
      if (i < 2) normal_gradients[p] += g;
    }
    for (std::size_t i = 0; i < 4; ++i) normal_gradients[i] += 0.25 * n_sq * element.gradients[2];
    normal_gradients[4] = (1 - n_sq) * element.gradients[2];
    const double viscous = rate * stretch_.viscosity;
    add_outer(element.area * (stretch_.weft * (1 - lateral_u) + viscous), of_u, w * cell_weights.of_height.x() / u,
              0.5 * cell_weights.of_skew.x() / u);
    add_outer(element.area * (stretch_.warp * (1 - lateral_v) + viscous), of_v, w * cell_weights.of_height.y() / v,
              0.5 * cell_weights.of_skew.y() / v);
    add_outer(element.area * 0.5 * (shear_.modulus + rate * shear_.viscosity), of_shear, 0, 0);
    const double weft = element.area * stretch_.weft * lateral_u, warp = element.area * stretch_.warp * lateral_v;
    const double stress = element.area * 0.5 * shear_.modulus * s.u.dot(s.v);
    const double shear = definite ? 0.5 * stress : stress, added = definite ? 0.5 * std::abs(stress) : 0;
    const auto stiffness = [&](const Vec2& a, const Vec2& b) {
      return (weft + added) * a.x() * b.x() + (warp + added) * a.y() * b.y() + shear * (a.x() * b.y() + a.y() * b.x());
    };
    for (std::size_t a = 0; a < 5; ++a)
      for (std::size_t b = 0; b < 5; ++b) {
        across[5 * a + b] += stiffness(flat[a], flat[b]);
        along[5 * a + b] += stiffness(normal_gradients[a], normal_gradients[b]);
      }
    of_height += cell_weights.of_height.dot(Vec2(weft, warp));
    of_twist += n_sq * cell_weights.of_skew.dot(Vec2(weft, warp));
  }
  for (std::size_t a = 0; a < 5; ++a)
    for (std::size_t b = 0; b < 5; ++b) {
      const double height = (a == 4 ? 1 : -0.25) * (b == 4 ? 1 : -0.25) * of_height;
      const std::size_t i = 5 * a + b;
      sum[i] = sum[i] + packed_scalar(across[i] + kTwist[a] * kTwist[b] * of_twist) +
               packed_outer((along[i] + height - across[i]) * n, n);
    }
  return sum;
}

double CrossedMembrane::strain(std::size_t triangle, std::span<const Vec3> x) const {
  const Cell& cell = cells_[triangle / 4];
  const Vec3 strains = strains_of(triangle / 4, triangle % 4, state_of(cell, vectors_of(cell, x)));
  return (strains.head<2>() - Vec2::Ones()).cwiseAbs().maxCoeff();
}

double CrossedMembrane::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const State state = state_of(cells_[c], vectors_of(cells_[c], x));
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 strains = strains_of(c, k, state);
      const Vec2 stretched = strains.head<2>() - Vec2::Ones();
      sum += elements()[4 * c + k].area * (0.5 * Vec2(stretch_.weft, stretch_.warp).dot(stretched.cwiseAbs2()) +
                                           0.25 * shear_.modulus * strains.z() * strains.z());
    }
  }
  return sum;
}

}  // namespace weft::forces
