// Air that a cloth encloses.
#pragma once

#include <vector>

#include "scene/keyed.hpp"

namespace weft::scene {

/// The quantity that a scene controls. The other one, pressure or amount, follows from the volume.
enum class PressureControl {
  gauge,  ///< pressure above that of the air outside [Pa]
  air,    ///< air that is pumped in after the cloth is closed, as volume at the pressure outside [m³]; negative: out
  fill,   ///< all air, as ratio of what the cloth encloses when it is closed
};

struct PressureKey {
  double time = 0;  ///< [s], strictly increasing
  double value = 0;
};

/// A cloth with air inside. What it encloses counts from the start, of cloth that is sewn from the end of sewing.
struct Pressure {
  PressureControl control = PressureControl::gauge;
  double value = 0;                                    ///< of what `control` says, where there are no keys
  Interpolation interpolation = Interpolation::cubic;  ///< between its keys
  std::vector<PressureKey> keys;                       ///< empty: always `value`

  /// Whether the air inside acts on the cloth at all.
  bool acts() const { return control != PressureControl::gauge || value != 0 || !keys.empty(); }
};

}  // namespace weft::scene
