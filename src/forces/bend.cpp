#include "forces/bend.hpp"

namespace weft::forces {
namespace {

Vec3 weighted_sum(const std::array<Index, 4>& particles, const std::array<double, 4>& weights,
                  std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k) sum += weights[k] * x[particles[k]];
  return sum;
}

}  // namespace

Bend::Bend(const mesh::Grid& grid, Index first, const BendParameters& parameters)
    : grid_(grid), first_(first), rigidity_(parameters.rigidity), damping_(parameters) {
  lay_out({});
}

void Bend::hold(std::span<const char> held) {
  lay_out(held);
}

// The same differences in the same order, whatever is held.
void Bend::lay_out(std::span<const char> held) {
  differences_.clear();
  const mesh::Grid& grid = grid_;
  const auto at = [&](int i, int j) { return first_ + grid.index(i, j); };
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      const bool last_i = i + 1 == grid.nu, last_j = j + 1 == grid.nv;
      if (i > 0 && !last_i)
        add_line({at(i - 1, j), at(i, j), at(i + 1, j)}, grid.du(i - 1), grid.du(i), grid.width_v(j), held);
      if (j > 0 && !last_j)
        add_line({at(i, j - 1), at(i, j), at(i, j + 1)}, grid.dv(j - 1), grid.dv(j), grid.width_u(i), held);
      // 2 ‖s_uv‖²: the mixed derivative counts twice.
      if (last_i || last_j) continue;
      const double cell = grid.du(i) * grid.dv(j), uv = 1 / cell;
      differences_.push_back(
          {{at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)}, {uv, -uv, -uv, uv}, 2 * cell, 4});
    }
  }
}

// Second derivative at the middle one of three places from their spacings, exact for parabolas: the turn from one side
// to the other over the length that it takes, half of both spacings, or of the one that is free. The weights add up to
// exactly zero, so that a motion of all of them leaves no rounding behind.
void Bend::add_line(const std::array<Index, 3>& particles, double before, double after, double width,
                    std::span<const char> held) {
  const auto is_held = [&](std::size_t k) { return !held.empty() && held[particles[k]]; };
  double length = 0.5 * (before + after);
  if (is_held(1) && is_held(0) != is_held(2)) length = 0.5 * (is_held(0) ? after : before);
  const double first = 1 / (before * length), last = 1 / (after * length);
  differences_.push_back(
      {{particles[0], particles[1], particles[2], particles[1]}, {first, -(first + last), last, 0}, length * width, 3});
}

void Bend::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Difference& d : differences_)
    for (int a = 0; a < d.count; ++a)
      for (int b = a + 1; b < d.count; ++b) pairs.emplace_back(d.particles[a], d.particles[b]);
}

void Bend::attach(const solver::BlockMatrix& matrix) {
  slots_.resize(differences_.size());
  for (std::size_t d = 0; d < differences_.size(); ++d)
    for (int a = 0; a < differences_[d].count; ++a)
      for (int b = 0; b < differences_[d].count; ++b)
        slots_[d][4 * a + b] = matrix.slot(differences_[d].particles[a], differences_[d].particles[b]);
}

void Bend::add(const Evaluation& at) const {
  for (std::size_t d = 0; d < differences_.size(); ++d) {
    const Difference& difference = differences_[d];
    const Vec3 curvature = weighted_sum(difference.particles, difference.weights, at.x);
    Vec3 moment = rigidity_ * curvature;
    if (damping_.any()) moment += damping(d, curvature, at);
    for (int k = 0; k < difference.count; ++k)
      at.force[difference.particles[k]] -= difference.area * difference.weights[k] * moment;
  }
}

// Moment against the rate of curvature; its Jacobian goes into the matrix, if there is one. The definite form of that
// is a stiffness c cᵀ, here ‖c‖² I: curvature points along the normal, where that is the same, and across it the
// membrane is much stiffer still. All of bending is numbers in place of blocks then.
Vec3 Bend::damping(std::size_t index, const Vec3& curvature, const Evaluation& at) const {
  const Difference& d = differences_[index];
  const Vec3 velocity = weighted_sum(d.particles, d.weights, at.v);
  const Vec3 c = at.rate > 0 ? Vec3(curvature - velocity / at.rate) : curvature;
  const double rate = c.dot(velocity), c_sq = c.squaredNorm();
  const auto [secant, tangent] = damping_.respond(c_sq, rate);
  if (at.matrix != nullptr && at.linearisation == Linearisation::exact) {
    add_blocks(index, at.rate * tangent * c * c.transpose(), *at.matrix);
  } else if (at.matrix != nullptr) {
    const double stiffness = d.area * at.rate * secant * c_sq;
    for (int a = 0; a < d.count; ++a)
      for (int b = 0; b < d.count; ++b)
        at.matrix->add_scalar(slots_[index][4 * a + b], stiffness * d.weights[a] * d.weights[b]);
  }
  return secant * rate * c;
}

void Bend::add_blocks(std::size_t index, const Mat3& stiffness, solver::BlockMatrix& matrix) const {
  const Difference& d = differences_[index];
  for (int a = 0; a < d.count; ++a)
    for (int b = 0; b < d.count; ++b)
      matrix.add(slots_[index][4 * a + b], d.area * d.weights[a] * d.weights[b], stiffness);
}

void Bend::add_constant_stiffness(solver::BlockMatrix& matrix) const {
  for (std::size_t d = 0; d < differences_.size(); ++d) {
    const Difference& difference = differences_[d];
    for (int a = 0; a < difference.count; ++a)
      for (int b = 0; b < difference.count; ++b)
        matrix.add_scalar(slots_[d][4 * a + b],
                          rigidity_ * difference.area * difference.weights[a] * difference.weights[b]);
  }
}

double Bend::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Difference& d : differences_)
    sum += 0.5 * rigidity_ * d.area * weighted_sum(d.particles, d.weights, x).squaredNorm();
  return sum;
}

}  // namespace weft::forces
