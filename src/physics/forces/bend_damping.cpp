#include "physics/forces/bend_damping.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {

BendDamping::BendDamping(const BendParameters& p) : viscosity_(p.viscosity), friction_(p.friction) {
  residual_curvature_ = std::max(kFlatCurvature, p.rigidity > 0 ? friction_ / p.rigidity : 0.0);
}

Mat3 BendDamping::stiffness(const Vec3& curvature, const Vec3& change, double rate) const {
  const Vec3 c = rate > 0 ? Vec3(curvature - change / rate) : curvature;
  const double c_sq = c.squaredNorm(), along = c.dot(change);
  const double residual_sq = c_sq + residual_curvature_ * residual_curvature_;
  const double smooth_sq = along * along + kStickRate * kStickRate * residual_sq;
  const double dry = friction_ / std::sqrt(residual_sq * smooth_sq);
  const double tangent = viscosity_ / (c_sq + kFlatCurvature * kFlatCurvature) + dry * (1 - along * along / smooth_sq);
  return rate * tangent * c * c.transpose();
}

}  // namespace weft::forces
