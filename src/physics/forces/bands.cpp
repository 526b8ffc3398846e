#include "physics/forces/bands.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {
namespace {

template <class Point>
Point curvature(const std::array<Index, 3>& p, const Vec3& weights, std::span<const Point> x) {
  return weights[0] * x[p[0]] + weights[1] * x[p[1]] + weights[2] * x[p[2]];
}

}  // namespace

Bands::Bands(const mesh::Sheet& sheet, Index first, double stretch) {
  for (const mesh::Band& band : sheet.bands) {
    const double stiffness = band.stiffness + stretch * band.allowance;
    for (std::size_t k = 0; stiffness > 0 && k < band.lengths.size(); ++k) {
      const Index a = band.vertices[k], b = band.vertices[k + 1];
      const double start = (sheet.rest[a] - sheet.rest[b]).norm();
      const double pattern_rest = band.ratio * band.lengths[k];
      pieces_.push_back(
          {{first + a, first + b}, stiffness, sheet.sewn ? start : pattern_rest, pattern_rest, pattern_rest});
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

void Bands::interpolate_rest_shape(double progress) {
  for (Piece& piece : pieces_)
    piece.rest = progress == 1 ? piece.pattern_rest : (1 - progress) * piece.start + progress * piece.pattern_rest;
}

void Bands::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Piece& piece : pieces_) append_pairs_of(piece.particles, pairs);
  for (const Bend& bend : bends_) append_pairs_of(bend.particles, pairs);
}

void Bands::attach(const solver::Assembly& assembly) {
  for (Piece& piece : pieces_) {
    const auto [i, j] = std::minmax(piece.particles[0], piece.particles[1]);
    piece.block = assembly.block(i, j);
  }
  for (Bend& bend : bends_)
    for (std::size_t k = 0; k < 3; ++k)
      bend.scalars[k] = assembly.scalar(bend.particles[k], bend.particles[(k + 1) % 3]);
}

void Bands::add(const Evaluation& at) const {
  for (const Piece& piece : pieces_) {
    const auto a = piece.particles[0], b = piece.particles[1];
    const Vec3 along = solver::vec3_of(at.x[b] - at.x[a]);
    const double length = along.norm();
    if (length == 0) continue;  // coinciding particles define no direction
    const auto pull = solver::padded<double>(piece.stiffness * (1 / piece.rest - 1 / length) * along);
    at.force.add(piece.particles[0], pull);
    at.force.subtract(piece.particles[1], pull);
    if (at.assembly)
      at.assembly.add(piece.block, Mat3(-stiffness(piece, along, std::max(1 - piece.rest / length, 0.0))));
  }
  for (const auto& [p, weights, stiffness, scalars] : bends_) {
    const solver::PaddedVec3<double> moment = stiffness * curvature(p, weights, at.x);
    for (std::size_t k = 0; k < 3; ++k) at.force.subtract(p[k], weights[static_cast<Eigen::Index>(k)] * moment);
  }
}

// Stiffness of a piece [N/m]. `along`: vector from its first particle to its second [m]. `lateral`: 1 − rest / length;
// add() raises it to at least 0, so that the matrix is positive semidefinite.
Mat3 Bands::stiffness(const Piece& piece, const Vec3& along, double lateral) {
  const Vec3 n = along.normalized();
  return piece.stiffness / piece.rest * ((1 - lateral) * n * n.transpose() + lateral * Mat3::Identity());
}

void Bands::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> /*v*/, double /*rate*/,
                         solver::BlockMatrix& jacobian) const {
  for (const Piece& piece : pieces_) {
    const auto [a, b] = piece.particles;
    const Vec3 along = x[b] - x[a];
    if (along.norm() == 0) continue;
    jacobian.add_spring(a, b, stiffness(piece, along, 1 - piece.rest / along.norm()));
  }
  for (const Bend& bend : bends_)
    for (Eigen::Index a = 0; a < 3; ++a)
      for (Eigen::Index b = 0; b < 3; ++b)
        jacobian.add_scalar(jacobian.slot(bend.particles[a], bend.particles[b]),
                            bend.stiffness * bend.weights[a] * bend.weights[b]);
}

void Bands::add_constant_stiffness(solver::Assembly& assembly) const {
  for (const auto& [p, weights, stiffness, scalars] : bends_)
    for (std::size_t k = 0; k < 3; ++k)
      assembly.add_scalar(scalars[k], stiffness * weights[static_cast<Eigen::Index>(k)] *
                                          weights[static_cast<Eigen::Index>((k + 1) % 3)]);
}

double Bands::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Piece& piece : pieces_) {
    const double strain = (x[piece.particles[1]] - x[piece.particles[0]]).norm() / piece.rest - 1;
    sum += 0.5 * piece.stiffness * piece.rest * strain * strain;
  }
  for (const Bend& bend : bends_)
    sum += 0.5 * bend.stiffness * curvature(bend.particles, bend.weights, x).squaredNorm();
  return sum;
}

}  // namespace weft::forces
