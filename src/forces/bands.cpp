#include "forces/bands.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {
namespace {

std::size_t at_index(Index i) {
  return static_cast<std::size_t>(i);
}

Vec3 curvature(const std::array<Index, 3>& p, const Vec3& weights, std::span<const Vec3> x) {
  return weights[0] * x[at_index(p[0])] + weights[1] * x[at_index(p[1])] + weights[2] * x[at_index(p[2])];
}

}  // namespace

Bands::Bands(const mesh::Sheet& sheet, Index first, double stretch) {
  for (const mesh::Band& band : sheet.bands) {
    const double stiffness = band.stiffness + stretch * band.allowance;
    for (std::size_t k = 0; stiffness > 0 && k < band.lengths.size(); ++k) {
      const Index a = band.vertices[k], b = band.vertices[k + 1];
      const double start = (sheet.rest[at_index(a)] - sheet.rest[at_index(b)]).norm();
      const double own = band.ratio * band.lengths[k];
      pieces_.push_back({{first + a, first + b}, stiffness, sheet.sewn ? start : own, own, own});
    }
    for (std::size_t k = 1; band.bend > 0 && k < band.lengths.size(); ++k) {
      const double before = band.lengths[k - 1], after = band.lengths[k], length = 0.5 * (before + after);
      const double w0 = 1 / (before * length), w2 = 1 / (after * length);
      bends_.push_back({{first + band.vertices[k - 1], first + band.vertices[k], first + band.vertices[k + 1]},
                        Vec3(w0, -w0 - w2, w2),
                        band.bend * length});
    }
  }
}

void Bands::rest_between_start_and_pattern(double share) {
  for (Piece& piece : pieces_) piece.rest = share == 1 ? piece.own : (1 - share) * piece.start + share * piece.own;
}

void Bands::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Piece& piece : pieces_) pairs.emplace_back(piece.particles[0], piece.particles[1]);
  for (const auto& [p, weights, stiffness, slots] : bends_)
    for (std::size_t k = 0; k < 3; ++k) pairs.emplace_back(p[k], p[(k + 1) % 3]);
}

void Bands::attach(const solver::BlockMatrix& matrix) {
  for (Piece& piece : pieces_)
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) piece.slots[2 * a + b] = matrix.slot(piece.particles[a], piece.particles[b]);
  for (Bend& bend : bends_)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) bend.slots[3 * a + b] = matrix.slot(bend.particles[a], bend.particles[b]);
}

void Bands::add(const Evaluation& at) const {
  for (const Piece& piece : pieces_) {
    const auto a = at_index(piece.particles[0]), b = at_index(piece.particles[1]);
    const Vec3 along = at.x[b] - at.x[a];
    const double length = along.norm();
    if (length == 0) continue;  // points nowhere
    const Vec3 n = along / length;
    const Vec3 pull = piece.stiffness * (length / piece.rest - 1) * n;
    at.force[a] += pull;
    at.force[b] -= pull;
    if (at.matrix == nullptr) continue;
    double lateral = 1 - piece.rest / length;
    if (at.linearisation != Linearisation::exact) lateral = std::max(lateral, 0.0);
    const Mat3 hessian =
        piece.stiffness / piece.rest * ((1 - lateral) * n * n.transpose() + lateral * Mat3::Identity());
    at.matrix->add(piece.slots[0], hessian);
    at.matrix->add(piece.slots[1], -hessian);
    at.matrix->add(piece.slots[2], -hessian);
    at.matrix->add(piece.slots[3], hessian);
  }
  for (const auto& [p, weights, stiffness, slots] : bends_) {
    const Vec3 moment = stiffness * curvature(p, weights, at.x);
    for (std::size_t k = 0; k < 3; ++k) at.force[at_index(p[k])] -= weights[static_cast<Eigen::Index>(k)] * moment;
  }
}

void Bands::add_constant_stiffness(solver::BlockMatrix& matrix) const {
  for (const auto& [p, weights, stiffness, slots] : bends_)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        matrix.add_scalar(slots[3 * a + b],
                          stiffness * weights[static_cast<Eigen::Index>(a)] * weights[static_cast<Eigen::Index>(b)]);
}

double Bands::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Piece& piece : pieces_) {
    const double strain = (x[at_index(piece.particles[1])] - x[at_index(piece.particles[0])]).norm() / piece.rest - 1;
    sum += 0.5 * piece.stiffness * piece.rest * strain * strain;
  }
  for (const Bend& bend : bends_)
    sum += 0.5 * bend.stiffness * curvature(bend.particles, bend.weights, x).squaredNorm();
  return sum;
}

}  // namespace weft::forces
