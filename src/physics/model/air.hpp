// Gravity and air.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::model {

/// Turbulence, added to the mean velocity of the air (GustField).
struct Gusts {
  double speed = 0;  ///< root mean square of each component [m/s]; 0: none
  double size = 1;   ///< integral length of the turbulence [m]
  int seed = 0;      ///< seed of the random directions and phases of gusts
};

/// Gravity and wind at one time.
struct PhysicsKey {
  double time = 0;     ///< [s], strictly increasing
  Vec3 gravity, wind;  ///< [m/s²]; velocity of the air [m/s]
};

struct Physics {
  Vec3 gravity{0, 0, -9.81};  ///< [m/s²]; the default is for z up
  double air_density = 1.2;   ///< [kg/m³]; 0: no air
  Vec3 wind{0, 0, 0};         ///< mean velocity of the air [m/s]
  Gusts gusts;
  motion::Interpolation interpolation = motion::Interpolation::cubic;  ///< between `keys`
  std::vector<PhysicsKey> keys;                                        ///< if any, they replace `gravity` and `wind`

  /// Largest magnitude of gravity of all keys; without keys, the magnitude of `gravity` [m/s²].
  double largest_gravity() const {
    double largest = keys.empty() ? gravity.norm() : 0;
    for (const PhysicsKey& key : keys) largest = std::max(largest, key.gravity.norm());
    return largest;
  }
};

struct FanKey {
  double time = 0;                             ///< [s], strictly increasing
  Vec3 position{0, 0, 0}, direction{1, 0, 0};  ///< centre of the outlet disc [m]; axis of the cone, not zero
  double speed = 5;                            ///< speed of the air at the centre of the disc [m/s]
};

/// A fan: it adds a flow of air in a cone to the wind (see Weather).
struct Fan {
  std::string name;
  std::vector<FanKey> keys{FanKey{}};  ///< at least one; a fan with a single key never changes
  motion::Interpolation interpolation = motion::Interpolation::cubic;  ///< between `keys`
  double radius = 0.25;                                                ///< of the outlet disc [m]
  double angle = 24;                                                   ///< full opening angle of the cone [degrees]
  double falloff = 1;  ///< n: the speed on the axis is proportional to 1 / (distance from the apex)ⁿ
};

}  // namespace weft::model
