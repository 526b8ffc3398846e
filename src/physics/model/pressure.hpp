// Air that a cloth encloses.
#pragma once

#include <vector>

#include "physics/motion/interpolation.hpp"

namespace weft::model {

/// Quantity that the model prescribes: the pressure, or an amount of air. From an amount of air and
/// the volume, the pressure follows at constant temperature.
enum class PressureControl {
  gauge,  ///< pressure above that of the outside air [Pa]
  air,    ///< air pumped in after the cloth was closed: its volume at outside pressure [m³]; negative: pumped out
  fill,   ///< all air inside: its volume at outside pressure, relative to the volume that the cloth
          ///< enclosed when it was closed [1]
};

struct PressureKey {
  double time = 0;   ///< [s], strictly increasing
  double value = 0;  ///< in the unit of Pressure::control
};

/// Air in a cloth. The cloth is closed from the start or, if it is sewn, from the end of sewing.
struct Pressure {
  PressureControl control = PressureControl::gauge;
  double value = 0;  ///< value of the prescribed quantity if there are no keys
  motion::Interpolation interpolation = motion::Interpolation::cubic;  ///< between `keys`
  std::vector<PressureKey> keys;                                       ///< empty: constant `value`

  /// Whether the enclosed air acts on the cloth. False only for a constant gauge pressure of 0.
  bool has_effect() const { return control != PressureControl::gauge || value != 0 || !keys.empty(); }
};

}  // namespace weft::model
