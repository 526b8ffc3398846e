#include "physics/forces/bend_damping.hpp"

#include <algorithm>
#include <cmath>

namespace weft::forces {

BendDamping::BendDamping(const BendParameters& p) : viscosity_(p.viscosity), friction_(p.friction) {
  residual_curvature_ = std::max(kFlatCurvature, p.rigidity > 0 ? friction_ / p.rigidity : 0.0);
}

double BendDamping::tangent(double c_sq, double rate) const {
  const double residual_sq = c_sq + residual_curvature_ * residual_curvature_;
  const double smooth_sq = rate * rate + kStickRate * kStickRate * residual_sq;
  const double dry = friction_ / std::sqrt(residual_sq * smooth_sq);
  return viscosity_ / (c_sq + kFlatCurvature * kFlatCurvature) + dry * (1 - rate * rate / smooth_sq);
}

}  // namespace weft::forces
