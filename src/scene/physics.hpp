// The world around the cloth: gravity and air.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "scene/keyed.hpp"

namespace weft::scene {

/// Turbulence of the air, beside its mean velocity.
struct Gusts {
  double speed = 0;  ///< root mean square of each component [m/s]; 0: none
  double size = 1;   ///< of the eddies that carry most: integral length [m]
  int seed = 0;      ///< another one gives other gusts
};

struct PhysicsKey {
  double time = 0;  ///< [s], strictly increasing
  Vec3 gravity, wind;
};

struct Physics {
  Vec3 gravity{0, 0, -9.81};  ///< [m/s²]; the default follows the up axis
  double air_density = 1.2;   ///< [kg/m³]; 0 leaves the air out
  Vec3 wind{0, 0, 0};         ///< velocity of the air [m/s]
  Gusts gusts;
  Interpolation interpolation = Interpolation::cubic;  ///< between its keys
  std::vector<PhysicsKey> keys;                        ///< of gravity and wind; empty: they stay as above

  /// Of all keys [m/s²].
  double largest_gravity() const {
    double largest = keys.empty() ? gravity.norm() : 0;
    for (const PhysicsKey& key : keys) largest = std::max(largest, key.gravity.norm());
    return largest;
  }
};

struct FanKey {
  double time = 0;                             ///< [s], strictly increasing
  Vec3 position{0, 0, 0}, direction{1, 0, 0};  ///< [m]; the way it blows, of any length but 0
  double speed = 5;                            ///< [m/s]
};

/// Wind in a cone, as of a ventilator; see environment::Weather.
struct Fan {
  std::string name;
  std::vector<FanKey> keys{FanKey{}};  ///< at least one; one: still
  Interpolation interpolation = Interpolation::cubic;
  double radius = 0.25;  ///< of the disc that it blows from [m]
  double angle = 24;     ///< full opening of the cone [degrees]
  double falloff = 1;    ///< the speed falls with this power of the distance from the apex of the cone
};

}  // namespace weft::scene
