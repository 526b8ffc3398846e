// What takes energy out of bending, the same for every mesh.
#pragma once

#include "forces/force.hpp"

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
/// Moment per area [N/m] against the rate of curvature κ̇ along c, the curvature itself:
///
///     η (c·κ̇) c / (‖c‖² + flat²)  +  τ (c·κ̇) c / (D √((c·κ̇)² + ε² D²)),  D² = ‖c‖² + kept².
///
/// The direction fades where the sheet is flat: for viscosity below kFlatCurvature, for friction below the curvature
/// that it can keep, where a moment of full size about an axis that turns with every ripple would be stiffer than the
/// bending itself.
class BendDamping {
 public:
  explicit BendDamping(const BendParameters& parameters);

  bool any() const { return viscosity_ > 0 || friction_ > 0; }
  /// `velocity`: rate of the curvature vector.
  Vec3 moment(const Vec3& curvature, const Vec3& velocity) const;
  /// What c (c·κ̇) is multiplied with, for four curvatures at once, from ‖c‖² and c·κ̇.
  Eigen::Array4d secants(const Eigen::Array4d& c_sq, const Eigen::Array4d& rate) const;

  struct Linearised {
    Vec3 moment;
    Mat3 jacobian;  ///< of the moment: ∂/∂c + rate ∂/∂κ̇
  };
  Linearised linearised(const Vec3& curvature, const Vec3& velocity, double rate, Linearisation linearisation) const;

 private:
  /// Scalar: double, or an array of them.
  template <class Scalar>
  struct Terms {
    Scalar rate, flat_sq, residual_sq, smooth_sq, viscous, dry;
  };
  template <class Scalar>
  Terms<Scalar> terms(const Scalar& c_sq, const Scalar& rate) const;

  double viscosity_, friction_;
  double residual_curvature_;  // below which friction fades [1/m]
};

}  // namespace weft::forces
