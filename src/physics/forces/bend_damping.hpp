// Viscosity and dry friction of bending, shared by the forces of grids, triangles and ropes.
#pragma once

#include <cmath>

#include "physics/forces/lanes.hpp"

namespace weft::forces {

struct BendParameters {
  double rigidity = 0;   ///< B [N·m]
  double viscosity = 0;  ///< η, moment per width, per rate of curvature [N·m·s]
  double friction = 0;  ///< τ, moment per width against a change of curvature [N]: half of Kawabata's 2HB (hysteresis)
};

/// Viscosity and friction act on each curvature vector κ separately: on the second derivatives
/// s_uu, s_uv and s_vv of the surface s(u, v), or on s'' of a rope. Only the part of the rate κ̇
/// along κ counts, so that damping hardly acts on a curved piece that turns rigidly (the error is
/// of second order in the angle per step). Friction models Kawabata's bending hysteresis ("The
/// Standardization and Analysis of Hand Evaluation", 1980): a moment of constant magnitude against
/// the change of curvature, smoothed below the rate kStickRate. Friction brings cloth to rest:
/// without it, the hem of a draped sheet keeps moving at centimetres per second.
///
/// Moment per width [N] (of a rope: moment [N·m]):
///
///     η (c·κ̇) c / (‖c‖² + κ_f²)  +  τ (c·κ̇) c / (D √((c·κ̇)² + ε² D²)),  D² = ‖c‖² + κ_r².
///
/// c is κ at x̂ = x − v / rate (see Evaluation): for implicit Euler and the midpoint rule the start of the step, for
/// BDF2 with constant steps about a third of a step later. If `rate` is 0, c is κ at x. κ_f is kFlatCurvature, κ_r is
/// residual_curvature_, ε is kStickRate. As c is constant during a step, the moment is the gradient of a convex
/// function of κ̇. If c were κ at the current iterate, the direction of c would change with every
/// ripple of nearly flat cloth, and Newton's method would oscillate (measured: a strip pulled over
/// a rod takes ten times the iterations). If c were κ at the positions that constant velocity
/// predicts, a draped sheet would tremble at 1 to 10 mm/s (measured with steps of 40 ms).
///
/// Damping fades out in nearly flat cloth: viscosity below the curvature kFlatCurvature, friction below
/// max(kFlatCurvature, τ/B), where τ/B is the curvature that friction can hold against elastic
/// bending. If damping did not fade out, the direction of the moment would change with every ripple
/// of nearly flat cloth, and damping would be stiffer than elastic bending.
class BendDamping {
  // Curvature below which the direction of κ is too uncertain for damping [1/m]: that of a radius
  // of 10 m.
  static constexpr double kFlatCurvature = 0.1;
  // Rate of curvature at which friction reaches 0.7 τ if ‖c‖ is far above κ_r [1/(m·s)]. At this
  // rate, the end of an evenly bending flap 10 cm long moves at 2.5 mm/s. With smaller values,
  // folds creep more slowly, but the system is stiffer: below kStickRate, friction acts like a
  // viscosity of τ / kStickRate.
  static constexpr double kStickRate = 0.5;

 public:
  explicit BendDamping(const BendParameters& parameters);

  bool is_active() const { return viscosity_ > 0 || friction_ > 0; }

  /// The moment of viscosity and friction is secant(‖c‖², c·κ̇) (c·κ̇) c. `Scalar`: double, or Lanes. Newton's matrix
  /// contains the secant instead of the tangent: with the tangent, Newton's method oscillates where friction changes
  /// sign, and takes 1.5 times the iterations.
  template <class Scalar>
  Scalar secant(const Scalar& c_sq, const Scalar& rate) const {
    using forces::sqrt, std::sqrt;
    const Scalar residual_sq = c_sq + residual_curvature_ * residual_curvature_;
    const Scalar smooth_sq = rate * rate + kStickRate * kStickRate * residual_sq;
    return viscosity_ / (c_sq + kFlatCurvature * kFlatCurvature) + friction_ / sqrt(residual_sq * smooth_sq);
  }
  /// Exact derivative of the moment with respect to κ̇, times `rate`, at the curvature κ and its rate of change κ̇.
  Mat3 stiffness(const Vec3& curvature, const Vec3& change, double rate) const;

 private:
  double viscosity_, friction_;
  double residual_curvature_;  // κ_r [1/m]
};

}  // namespace weft::forces
