// What takes energy out of bending, the same for every mesh.
#pragma once

#include <cmath>

#include "forces/lanes.hpp"

namespace weft::forces {

struct BendParameters {
  double rigidity = 0;   ///< B [N·m]
  double viscosity = 0;  ///< moment per rate of curvature [N·m·s]
  double friction = 0;   ///< moment per width that a change of curvature must overcome [N]; half of KES' 2HB
};

/// Viscosity and friction act on the rate of ‖s_uu‖ and so on, along the unit vector of the curvature itself, so that a
/// curved piece may turn rigidly without loss. Friction is that of Kawabata's hysteresis of bending ("The
/// Standardization and Analysis of Hand Evaluation", 1980): a moment of constant size against the change, smooth below
/// a rate of kStickRate. Without it the hem of a draped sheet tips over at a few centimetres a second for seconds on
/// end; with it the sheet lies still.
///
/// Moment per area [N/m] against the rate of curvature κ̇ along c:
///
///     η (c·κ̇) c / (‖c‖² + flat²)  +  τ (c·κ̇) c / (D √((c·κ̇)² + ε² D²)),  D² = ‖c‖² + kept².
///
/// c is the curvature at x̂, where the step began (x − v / rate; of BDF2 a third of a step later): the same in all of
/// the step, so that the moment is the gradient of a convex function of κ̇. With the direction at the iterate, which
/// where cloth is nearly flat turns with every ripple, Newton's method went to and fro without end: a strip pulled over
/// a rod, solved to a hundredth of its error, took 6,650 iterations and 68 steps that were rejected, and takes 631 and
/// none. With that of unchanged velocity a draped sheet with steps of 40 ms trembled by 1 to 10 mm/s.
///
/// The direction fades where the sheet is flat: for viscosity below kFlatCurvature, for friction below the curvature
/// that it can keep, where a moment of full size about an axis that turns with every ripple would be stiffer than the
/// bending itself.
class BendDamping {
  // Curvature below which its direction is too uncertain to damp along [1/m]: a radius of 10 m is flat to the eye.
  static constexpr double kFlatCurvature = 0.1;
  // Rate of curvature at which friction has reached most of its size [1/(m·s)]: a fold of 10 cm then moves at 5 mm/s.
  // Smaller holds better and makes the system stiffer: friction / kStickRate acts like a viscosity.
  static constexpr double kStickRate = 0.5;

 public:
  explicit BendDamping(const BendParameters& parameters);

  bool any() const { return viscosity_ > 0 || friction_ > 0; }

  /// The moment is this times (c·κ̇) c, from ‖c‖² and c·κ̇; `Scalar`: double, or Lanes. Newton's matrix takes it too:
  /// with the tangent, definite as well, it jumps to and fro over the kink of friction at rest and takes half as many
  /// iterations more.
  template <class Scalar>
  Scalar secant(const Scalar& c_sq, const Scalar& rate) const {
    using forces::sqrt, std::sqrt;
    const Scalar residual_sq = c_sq + residual_curvature_ * residual_curvature_;
    const Scalar smooth_sq = rate * rate + kStickRate * kStickRate * residual_sq;
    return viscosity_ / (c_sq + kFlatCurvature * kFlatCurvature) + friction_ / sqrt(residual_sq * smooth_sq);
  }
  /// And its derivative with respect to κ̇ this times c cᵀ.
  double tangent(double c_sq, double rate) const;

 private:
  double viscosity_, friction_;
  double residual_curvature_;  // below which friction fades [1/m]
};

}  // namespace weft::forces
