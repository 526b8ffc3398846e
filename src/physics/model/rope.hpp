// Ropes: thin chains of particles.
#pragma once

#include <vector>

#include "physics/motion/interpolation.hpp"

namespace weft::model {

/// Minimum length of a piece between two particles [diameters].
inline constexpr double kMinRopePiece = 1.5;

/// Rest length of a rope at one time. If the length changes, the rest lengths of all pieces change
/// by the same factor.
struct RopeKey {
  double time = 0;    ///< [s], strictly increasing
  double length = 1;  ///< rest length [m]
};

/// Properties of a rope: a cloth that is a chain of particles instead of a sheet.
struct Rope {
  std::vector<double> lengths;  ///< rest lengths of its pieces [m]; a closed rope has as many pieces as particles
  bool closed = false;          ///< whether its last particle is connected to its first
  double mass = 0;              ///< [kg/m]
  double stretch = 0;           ///< stiffness EA: force per strain [N]
  double bend = 0;              ///< bending stiffness EI [N·m²]
  double damping = 0;           ///< viscosity of stretch and bending, relative to their stiffness [s]
  double diameter = 0;          ///< contact diameter [m]
  double drag = 0;              ///< drag coefficient of a cylinder, for motion across the rope
  motion::Interpolation interpolation = motion::Interpolation::cubic;  ///< between `keys`
  std::vector<RopeKey> keys;  ///< of the rest length; if empty, the rest length stays the sum of `lengths`
};

}  // namespace weft::model
