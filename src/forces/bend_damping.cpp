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
BendDamping::Response<Scalar> BendDamping::respond(const Scalar& c_sq, const Scalar& rate) const {
  using std::sqrt;
  const Scalar residual_sq = c_sq + residual_curvature_ * residual_curvature_;
  const Scalar smooth_sq = rate * rate + kStickRate * kStickRate * residual_sq;
  const Scalar viscous = viscosity_ / (c_sq + kFlatCurvature * kFlatCurvature);
  const Scalar dry = friction_ / sqrt(residual_sq * smooth_sq);
  return {viscous + dry, viscous + dry * (1 - rate * rate / smooth_sq)};
}

template BendDamping::Response<double> BendDamping::respond(const double&, const double&) const;
template BendDamping::Response<Eigen::Array4d> BendDamping::respond(const Eigen::Array4d&, const Eigen::Array4d&) const;

}  // namespace weft::forces
