// Air that a cloth encloses.
#pragma once

#include <vector>

#include "physics/motion/interpolation.hpp"

namespace weft::model {

/// Quantity that the model prescribes: the pressure, or an amount of air from which the pressure follows by the volume.
enum class PressureControl {
  gauge,  ///< pressure above that of the outside air [Pa]
  air,    ///< air pumped in after closing, as its volume at outside pressure [m³]; negative: let out
  fill,   ///< total air: its volume at outside pressure, relative to the volume enclosed at closing [1]
};

struct PressureKey {
  double time = 0;  ///< [s], strictly increasing
  double value = 0;
};

/// Air in a cloth. The cloth is closed from the start or, if it is sewn, from the end of sewing.
struct Pressure {
  PressureControl control = PressureControl::gauge;
  double value = 0;  ///< value of the controlled quantity if there are no keys
  motion::Interpolation interpolation = motion::Interpolation::cubic;  ///< between `keys`
  std::vector<PressureKey> keys;                                       ///< empty: constant `value`

  /// Whether the enclosed air has any effect on the cloth.
  bool acts() const { return control != PressureControl::gauge || value != 0 || !keys.empty(); }
};

}  // namespace weft::model
