// Fabrics by name, from published measurements.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// A value, and whether it was measured or estimated by the rules of fabrics.cpp.
struct Figure {
  double value = 0;
  bool estimated = false;
};

/// Quantities that textile laboratories measure of a fabric.
struct Measurements {
  Figure density;                         ///< [kg/m²]
  Figure thickness;                       ///< of the cloth itself [m]
  Figure extension_weft, extension_warp;  ///< EMT: strain at 490 N/m, the maximum load of KES [1]
  Figure shear;                           ///< G, shear force per width over shear angle [N/m]
  Figure bend_weft, bend_warp;            ///< B [N·m]
  Figure hysteresis;  ///< HB / B, residual curvature after unloading [1/m]; HB: moment per width [N]
  std::optional<std::pair<double, double>> drape;  ///< Cusick's coefficient: minimum and maximum published values [1]
};

struct Fabric {
  Material material;  ///< from `measured`, except contact, friction and drag; `fabric` is the name
  Measurements measured;
  Finish finish;       ///< chosen by fibre and weave, not measured
  bool frays;          ///< cut edges fray, so they are hemmed
  std::string what;    ///< weave and kind
  std::string source;  ///< publication of the measurements
};

/// kExtensionLoad: load of the KES extension test (500 gf/cm) [N/m]. kWornLoad: load of worn cloth (20 gf/cm, as in
/// FAST) [N/m]; Material's `stretch` is the secant stiffness up to this load.
inline constexpr double kExtensionLoad = 490.3, kWornLoad = 19.6;

/// All named fabrics; the first is the default and equals Material{}.
std::span<const Fabric> fabrics();
const Fabric* find_fabric(std::string_view name);
std::vector<std::string> fabric_names();

}  // namespace weft::scene
