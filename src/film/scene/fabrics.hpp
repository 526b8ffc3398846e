// Fabrics by name, from published measurements.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// A value, and whether the rules of fabrics.cpp estimate it because no measurement is known.
struct MeasuredValue {
  double value = 0;
  bool estimated = false;
};

/// Quantities of a fabric that textile laboratories measure. EMT, G, B and HB are names of KES (see fabrics.cpp).
struct Measurements {
  MeasuredValue density;                         ///< [kg/m²]
  MeasuredValue thickness;                       ///< of the cloth itself [m]
  MeasuredValue extension_weft, extension_warp;  ///< EMT: strain at kExtensionLoad [1]
  MeasuredValue shear;                           ///< G: shear force per width / shear angle [N/m]
  MeasuredValue bend_weft, bend_warp;            ///< B: bending stiffness per width [N·m]
  MeasuredValue hysteresis;  ///< HB / B: residual curvature after unloading [1/m]; HB: moment per width [N]
  std::optional<std::pair<double, double>> drape;  ///< Cusick's coefficient: smallest and largest published value [1]
};

struct Fabric {
  Material material;  ///< contact thickness, friction and drag are chosen, the other members derived from `measured`
  Measurements measured;
  Finish finish;       ///< chosen by fibre and weave, not measured
  bool frays;          ///< cut edges fray, and are therefore drawn with hems
  std::string what;    ///< weave and kind
  std::string source;  ///< publication of the measurements
};

/// kExtensionLoad: maximum load of the extension test of KES (500 gf/cm) [N/m]. kWornLoad: load of worn cloth (20
/// gf/cm, one of the loads of FAST) [N/m]; Material::stretch_weft and stretch_warp are the secant stiffnesses up to
/// this load.
inline constexpr double kExtensionLoad = 490.3, kWornLoad = 19.6;

/// All fabrics. The first is the default: its material equals Material{}.
std::span<const Fabric> fabrics();
const Fabric* find_fabric(std::string_view name);
std::vector<std::string> fabric_names();

}  // namespace weft::scene
