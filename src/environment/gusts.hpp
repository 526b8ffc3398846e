// Gusts of wind: turbulence beside the mean velocity of the air.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace weft::environment {

/// A field of velocities that is smooth, free of divergence and the same in every run: a sum of waves whose directions
/// and phases hang on the seed (kinematic simulation: Fung, Hunt, Malik & Perkins, "Kinematic simulation of homogeneous
/// turbulence by unsteady random Fourier modes", J. Fluid Mech. 236, 1992). Their energies follow von Kármán's
/// spectrum,
///
///     E(k) ~ k⁴ / (k² + k_e²)^(17/6),
///
/// which falls with k^(−5/3); k_e such that `size` is the integral length. Waves are carried along by the mean wind and
/// change at half the rate at which eddies of their size turn over.
class Gusts {
 public:
  /// `wind`: the mean velocity of the air [m/s].
  Gusts(const scene::Gusts& gusts, const Vec3& wind);

  /// What the air at x [m] has beside its mean velocity at time t [s], in [m/s].
  Vec3 at(const Vec3& x, double t) const;

 private:
  struct Wave {
    Vec3 wave_number;    // [1/m]
    Vec3 amplitude;      // across it [m/s]
    double rate, phase;  // [1/s], [rad]
  };
  std::vector<Wave> waves_;
};

}  // namespace weft::environment
