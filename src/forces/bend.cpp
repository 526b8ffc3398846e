#include "forces/bend.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {
namespace {

// Curvature below which its direction is too uncertain to damp along [1/m]: a radius of 10 m is flat to the eye.
constexpr double kFlatCurvature = 0.1;

// Rate of curvature at which friction has reached most of its size [1/(m·s)]: a fold of 10 cm then moves at 5 mm/s.
// Smaller holds better and makes the system stiffer: friction / kRestRate acts like a viscosity.
constexpr double kRestRate = 0.5;

Vec3 weighted_sum(const std::array<Index, 4>& particles, const std::array<double, 4>& weights,
                  std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k) sum += weights[k] * x[static_cast<std::size_t>(particles[k])];
  return sum;
}

}  // namespace

Bend::Bend(const mesh::Grid& grid, Index first, const BendParameters& parameters)
    : rigidity_(parameters.rigidity), viscosity_(parameters.viscosity), friction_(parameters.friction) {
  kept_curvature_ = std::max(kFlatCurvature, rigidity_ > 0 ? friction_ / rigidity_ : 0.0);
  const auto at = [&](int i, int j) { return first + grid.index(i, j); };
  const double uu = 1 / (grid.lu * grid.lu), vv = 1 / (grid.lv * grid.lv), uv = 1 / (grid.lu * grid.lv);
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      if (i > 0 && i + 1 < grid.nu)
        add_difference({at(i - 1, j), at(i, j), at(i + 1, j), at(i, j)}, {uu, -2 * uu, uu, 0},
                       grid.lu * line_width(j, grid.nv, grid.lv), 3);
      if (j > 0 && j + 1 < grid.nv)
        add_difference({at(i, j - 1), at(i, j), at(i, j + 1), at(i, j)}, {vv, -2 * vv, vv, 0},
                       grid.lv * line_width(i, grid.nu, grid.lu), 3);
      // 2 ‖s_uv‖²: the mixed derivative counts twice.
      if (i + 1 < grid.nu && j + 1 < grid.nv)
        add_difference({at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)}, {uv, -uv, -uv, uv},
                       2 * grid.lu * grid.lv, 4);
    }
  }
}

void Bend::add_difference(std::array<Index, 4> particles, std::array<double, 4> weights, double area, int count) {
  differences_.push_back({particles, weights, area, count});
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
  for (const Difference& d : differences_) {
    const Vec3 moment = rigidity_ * d.area * weighted_sum(d.particles, d.weights, at.x);
    for (int k = 0; k < d.count; ++k) at.force[static_cast<std::size_t>(d.particles[k])] -= d.weights[k] * moment;
  }
  if (viscosity_ > 0 || friction_ > 0)
    for (std::size_t d = 0; d < differences_.size(); ++d) add_damping(d, at);
}

// Damping per area acts along the curvature, with a direction that fades where the sheet is flat: for viscosity below
// kFlatCurvature, for friction below the curvature that it can keep, where a moment of full size about an axis that
// turns with every ripple would be stiffer than the bending itself.
void Bend::add_damping(std::size_t index, const Evaluation& at) const {
  const Difference& d = differences_[index];
  const Vec3 curvature = weighted_sum(d.particles, d.weights, at.x);
  const Vec3 velocity = weighted_sum(d.particles, d.weights, at.v);
  const auto direction = [&](double flat) {
    return Vec3(curvature / std::sqrt(curvature.squaredNorm() + flat * flat));
  };
  const Vec3 viscous = direction(kFlatCurvature), dry = direction(kept_curvature_);
  const double viscous_rate = viscous.dot(velocity), dry_rate = dry.dot(velocity);
  const double smooth_rate = std::sqrt(dry_rate * dry_rate + kRestRate * kRestRate);
  const double viscosity = d.area * viscosity_, friction = d.area * friction_ / smooth_rate;  // moment per rate
  const Vec3 moment = viscosity * viscous_rate * viscous + friction * dry_rate * dry;
  for (int k = 0; k < d.count; ++k) at.force[static_cast<std::size_t>(d.particles[k])] -= d.weights[k] * moment;
  if (at.matrix == nullptr) return;

  // The definite form takes the secant of friction: its tangent is definite too, but with it Newton's method jumps to
  // and fro over the kink at rest and takes half as many iterations more.
  Mat3 block = at.rate * (viscosity * viscous * viscous.transpose() + friction * dry * dry.transpose());
  if (at.linearisation == Linearisation::exact) {
    // Directions turn with the curvature; left out of the definite form as in Stretch.
    const auto turning = [&](double flat, const Vec3& n) {
      return Mat3((Mat3::Identity() - n * n.transpose()) / std::sqrt(curvature.squaredNorm() + flat * flat));
    };
    const Mat3 viscous_turning = turning(kFlatCurvature, viscous), dry_turning = turning(kept_curvature_, dry);
    const double tangent = friction * kRestRate * kRestRate / (smooth_rate * smooth_rate);
    block += (tangent - friction) * at.rate * dry * dry.transpose();
    block += viscosity * (viscous * (viscous_turning * velocity).transpose() + viscous_rate * viscous_turning);
    block += tangent * dry * (dry_turning * velocity).transpose() + friction * dry_rate * dry_turning;
  }
  for (int a = 0; a < d.count; ++a)
    for (int b = 0; b < d.count; ++b) at.matrix->add(slots_[index][4 * a + b], d.weights[a] * d.weights[b] * block);
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
