#include "physics/forces/rope_force.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {
namespace {

template <class Points>
Vec3 vec_at(const Points& x, Index i) {
  return solver::vec3_of(x[at(i)]);
}

double piece_length(std::span<const Vec3> x, const std::array<Index, 2>& ends) {
  return (x[at(ends[1])] - x[at(ends[0])]).norm();
}

template <class Element, class Points>
Vec3 second_difference(const Element& bend, const Points& x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += bend.weights[k] * vec_at(x, bend.particles[k]);
  return sum;
}

solver::PackedBlock packed_block(const Mat3& m) {
  return {Lanes{m(0, 0), m(1, 0), m(2, 0), m(0, 1)}, Lanes{m(1, 1), m(2, 1), m(0, 2), m(1, 2)},
          Lanes{m(2, 2), 0, 0, 0}};
}

}  // namespace

RopeForce::RopeForce(std::span<const double> lengths, bool closed, Index first, const RopeForceParameters& parameters)
    : Membrane(first), parameters_(parameters), damping_({parameters.bend, parameters.bend_viscosity, 0}) {
  const auto pieces = static_cast<Index>(lengths.size()), particles = closed ? pieces : pieces + 1;
  const auto particle = [&](Index i) { return first + i % particles; };
  for (Index p = 0; p < pieces; ++p) pieces_.push_back({{particle(p), particle(p + 1)}, lengths[at(p)], 0, 0, 0});
  if (parameters.bend > 0 || parameters.bend_viscosity > 0)
    for (Index p = 0; p < (closed ? pieces : pieces - 1); ++p) {
      const double before = lengths[at(p)], after = lengths[at((p + 1) % pieces)];
      bends_.push_back({{particle(p), particle(p + 1), particle(p + 2)}, before, after, 0.5 * (before + after)});
    }
  set_length_ratio(1);
}

void RopeForce::compute_weights(BendElement& bend) const {
  bend.length = length_ratio_ * bend.initial_length;
  const double one = 1 / (length_ratio_ * bend.before * bend.length),
               other = 1 / (length_ratio_ * bend.after * bend.length);
  bend.weights = {one, -(one + other), other};
}

// At a clamp (the middle particle and exactly one end are held), the second difference covers only the half piece on
// the free side; see Bend.
void RopeForce::set_held(std::span<const char> held) {
  for (BendElement& bend : bends_) {
    const auto is_held = [&](std::size_t k) { return held[at(bend.particles[k])] != 0; };
    bend.initial_length = 0.5 * (bend.before + bend.after);
    if (is_held(1) && is_held(0) != is_held(2)) bend.initial_length = 0.5 * (is_held(0) ? bend.after : bend.before);
    compute_weights(bend);
  }
}

bool RopeForce::set_length_ratio(double ratio) {
  if (ratio == length_ratio_) return false;
  length_ratio_ = ratio;
  for (Piece& piece : pieces_) {
    piece.rest = ratio * piece.initial_length;
    piece.elasticity = parameters_.stretch / piece.rest;
    piece.viscosity = parameters_.stretch_viscosity / piece.rest;
  }
  for (BendElement& bend : bends_) compute_weights(bend);
  return !bends_.empty();
}

void RopeForce::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Piece& piece : pieces_) append_pairs_of(piece.particles, pairs);
  for (const BendElement& bend : bends_) append_pairs_of(bend.particles, pairs);
}

void RopeForce::attach(const solver::Assembly& assembly) {
  const auto block = [&](Index a, Index b) { return assembly.block(std::min(a, b), std::max(a, b)); };
  for (Piece& piece : pieces_) piece.block = block(piece.particles[0], piece.particles[1]);
  for (BendElement& bend : bends_)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = bend.particles[k], b = bend.particles[(k + 1) % 3];
      bend.scalars[k] = assembly.scalar(a, b);
      bend.blocks[k] = block(a, b);
    }
}

void RopeForce::add(const Evaluation& at) const {
  const bool has_air = parameters_.air_density > 0 && parameters_.drag > 0;
  for (const Piece& piece : pieces_) {
    add_stretch(piece, at);
    if (has_air) add_air(piece, at);
  }
  for (const BendElement& bend : bends_) add_bend(bend, at);
}

void RopeForce::add_stretch(const Piece& piece, const Evaluation& at) const {
  const Index a = piece.particles[0], b = piece.particles[1];
  const Vec3 d = vec_at(at.x, b) - vec_at(at.x, a);
  const double length = std::max(d.norm(), kMinStretch * piece.rest);
  const Vec3 n = d / length;
  double tension = piece.elasticity * (length - piece.rest);
  if (piece.viscosity > 0)
    tension += piece.viscosity * at.rate_of(
                                     length, [&](std::span<const Vec3> x) { return piece_length(x, piece.particles); },
                                     [&] { return n.dot(vec_at(at.v, b) - vec_at(at.v, a)); });
  const auto pull = solver::padded<double>(tension * n);
  at.force.add(a, pull);
  at.force.subtract(b, pull);
  if (!at.assembly) return;
  // The matrix omits the negative stiffness across a compressed piece; see Stretch::add().
  const double lateral = piece.elasticity * std::max(1 - piece.rest / length, 0.0);
  const double along = piece.elasticity + at.rate * piece.viscosity;
  at.assembly.add(piece.block, Mat3((lateral - along) * n * n.transpose() - lateral * Mat3::Identity()));
}

void RopeForce::add_air(const Piece& piece, const Evaluation& at) const {
  const auto [a, b] = piece.particles;
  const Vec3 d = vec_at(at.x, b) - vec_at(at.x, a);
  const double length = d.norm();
  if (!(length > 0)) return;
  Vec3 v = 0.5 * (vec_at(at.v, a) + vec_at(at.v, b));
  v -= at.air_velocity.empty() ? parameters_.wind
                               : Vec3(0.5 * (vec_at(at.air_velocity, a) + vec_at(at.air_velocity, b)));
  const Vec3 n = d / length, across = v - n.dot(v) * n;
  const double speed = across.norm();
  if (!(speed > 0)) return;
  // Drag on one end, divided by the squared speed [kg/m].
  const double coefficient = 0.25 * parameters_.air_density * parameters_.drag * parameters_.diameter * length;
  const auto drag = solver::padded<double>(coefficient * speed * across);
  at.force.subtract(a, drag);
  at.force.subtract(b, drag);
  if (!at.assembly) return;
  // Derivative with respect to velocities, lumped on the diagonal; see Air.
  const auto damping = packed_block(
      at.rate * coefficient * (speed * (Mat3::Identity() - n * n.transpose()) + across * across.transpose() / speed));
  at.assembly.add_to_own_block(a, damping);
  at.assembly.add_to_own_block(b, damping);
}

void RopeForce::add_bend(const BendElement& bend, const Evaluation& at) const {
  const Vec3 curvature = second_difference(bend, at.x);
  Vec3 moment = parameters_.bend * curvature;
  if (damping_.is_active()) {
    const Vec3 velocity = second_difference(bend, at.v);
    const Vec3 c = at.rate > 0 ? Vec3(curvature - velocity / at.rate) : curvature;
    const double rate = c.dot(velocity), secant = damping_.secant(c.squaredNorm(), rate);
    moment += secant * rate * c;
    if (at.assembly)
      for (std::size_t k = 0; k < 3; ++k)
        at.assembly.add(bend.blocks[k], Mat3(at.rate * bend.length * secant * bend.weights[k] *
                                             bend.weights[(k + 1) % 3] * c * c.transpose()));
  }
  for (std::size_t k = 0; k < 3; ++k)
    at.force.subtract(bend.particles[k], solver::padded<double>(bend.length * bend.weights[k] * moment));
}

void RopeForce::add_constant_stiffness(solver::Assembly& assembly) const {
  for (const BendElement& bend : bends_)
    for (std::size_t k = 0; k < 3; ++k)
      assembly.add_scalar(bend.scalars[k],
                          parameters_.bend * bend.length * bend.weights[k] * bend.weights[(k + 1) % 3]);
}

void RopeForce::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                             solver::BlockMatrix& jacobian) const {
  for (const Piece& piece : pieces_) {
    const auto [a, b] = piece.particles;
    jacobian.add_spring(a, b,
                        spring_stiffness(x[at(b)] - x[at(a)], v[at(b)] - v[at(a)], piece.rest, piece.elasticity,
                                         piece.viscosity, rate));
  }
  for (const BendElement& bend : bends_) {
    const Mat3 damping = damping_.stiffness(second_difference(bend, x), second_difference(bend, v), rate);
    const Mat3 stiffness = bend.length * (parameters_.bend * Mat3::Identity() + damping);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        jacobian.add(jacobian.slot(bend.particles[a], bend.particles[b]), bend.weights[a] * bend.weights[b], stiffness);
  }
}

double RopeForce::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Piece& piece : pieces_) {
    const double extension = piece_length(x, piece.particles) - piece.rest;
    sum += 0.5 * piece.elasticity * extension * extension;
  }
  for (const BendElement& bend : bends_)
    sum += 0.5 * parameters_.bend * bend.length * second_difference(bend, x).squaredNorm();
  return sum;
}

void RopeForce::for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const {
  for (const Piece& piece : pieces_)
    visit(std::abs(piece_length(x, piece.particles) / piece.rest - 1), piece.particles);
}

std::vector<double> lumped_masses(std::span<const double> lengths, bool closed, double mass) {
  std::vector<double> masses(lengths.size() + (closed ? 0 : 1));
  for (std::size_t p = 0; p < lengths.size(); ++p)
    for (const std::size_t end : {p, (p + 1) % masses.size()}) masses[end] += 0.5 * mass * lengths[p];
  return masses;
}

}  // namespace weft::forces
