// Gusts of wind: turbulence added to the mean velocity of the air.
#pragma once

#include <vector>

#include "physics/model/air.hpp"

namespace weft::model {

/// A smooth, divergence-free velocity field: a sum of waves with random directions and phases
/// (kinematic simulation: Fung, Hunt, Malik & Perkins, "Kinematic simulation of homogeneous
/// turbulence by unsteady random Fourier modes", J. Fluid Mech. 236, 1992). Gusts::seed determines
/// the random values, so the field is the same in every run. The energies of the waves follow von
/// Kármán's spectrum,
///
///     E(k) ~ k⁴ / (k² + k_e²)^(17/6) for the wave number k.
///
/// At large k, this spectrum falls as k^(−5/3). k_e is chosen so that Gusts::size is the integral
/// length. The waves move with the mean wind. In addition, the phase of each wave changes at half
/// the turnover rate of eddies of its size.
class GustField {
 public:
  /// `wind`: the mean velocity of the air [m/s].
  GustField(const Gusts& gusts, const Vec3& wind);

  /// Velocity of the air at x [m] and time t [s], relative to the mean wind [m/s].
  Vec3 at(const Vec3& x, double t) const;

 private:
  struct Wave {
    Vec3 wave_number;    // wave vector [rad/m]
    Vec3 amplitude;      // perpendicular to wave_number [m/s]
    double rate, phase;  // rate of the phase at a fixed place [rad/s]; phase at x = 0, t = 0 [rad]
  };
  std::vector<Wave> waves_;
};

}  // namespace weft::model
