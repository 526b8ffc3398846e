#include "forces/bend_damping.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {
namespace {

// Curvature below which its direction is too uncertain to damp along [1/m]: a radius of 10 m is flat to the eye.
constexpr double kFlatCurvature = 0.1;

// Rate of curvature at which friction has reached most of its size [1/(m·s)]: a fold of 10 cm then moves at 5 mm/s.
// Smaller holds better and makes the system stiffer: friction / kStickRate acts like a viscosity.
constexpr double kStickRate = 0.5;

}  // namespace

BendDamping::BendDamping(const BendParameters& p) : viscosity_(p.viscosity), friction_(p.friction) {
  residual_curvature_ = std::max(kFlatCurvature, p.rigidity > 0 ? friction_ / p.rigidity : 0.0);
}

template <class Scalar>
BendDamping::Terms<Scalar> BendDamping::terms(const Scalar& c_sq, const Scalar& rate) const {
  using std::sqrt;
  Terms<Scalar> t;
  t.rate = rate;
  t.flat_sq = c_sq + kFlatCurvature * kFlatCurvature;
  t.residual_sq = c_sq + residual_curvature_ * residual_curvature_;
  t.smooth_sq = rate * rate + kStickRate * kStickRate * t.residual_sq;
  t.viscous = viscosity_ / t.flat_sq;
  t.dry = friction_ / sqrt(t.residual_sq * t.smooth_sq);
  return t;
}

Vec3 BendDamping::moment(const Vec3& curvature, const Vec3& velocity) const {
  const auto t = terms(curvature.squaredNorm(), curvature.dot(velocity));
  return (t.viscous + t.dry) * t.rate * curvature;
}

Eigen::Array4d BendDamping::secants(const Eigen::Array4d& c_sq, const Eigen::Array4d& rate) const {
  const auto t = terms(c_sq, rate);
  return t.viscous + t.dry;
}

BendDamping::Linearised BendDamping::linearised(const Vec3& curvature, const Vec3& velocity, double rate,
                                                Linearisation linearisation) const {
  const auto t = terms(curvature.squaredNorm(), curvature.dot(velocity));
  // The definite form takes the secant of friction: its tangent is definite too, but with it Newton's method jumps to
  // and fro over the kink at rest and takes half as many iterations more.
  Mat3 jacobian = rate * (t.viscous + t.dry) * curvature * curvature.transpose();
  if (linearisation == Linearisation::exact) {
    const double dry_by_rate = -t.dry * t.rate * t.rate / t.smooth_sq;  // d dry/d rate · rate
    const double dry_by_c_sq = -0.5 * t.dry * (1 / t.residual_sq + kStickRate * kStickRate / t.smooth_sq);
    jacobian += dry_by_rate * curvature * (velocity + rate * curvature).transpose();
    jacobian += (t.viscous + t.dry) * (t.rate * Mat3::Identity() + curvature * velocity.transpose());
    jacobian += 2 * t.rate * (dry_by_c_sq - t.viscous / t.flat_sq) * curvature * curvature.transpose();
  }
  return {(t.viscous + t.dry) * t.rate * curvature, jacobian};
}

}  // namespace weft::forces
