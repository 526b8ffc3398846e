// Fabrics by name, from published measurements.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// A value, and whether it is estimated by the rules in fabrics.cpp, because no measurement is known.
struct MeasuredValue {
  double value = 0;
  bool estimated = false;
};

/// Quantities of a fabric that textile laboratories measure. EMT, G, B and HB are names of KES (see fabrics.cpp).
struct Measurements {
  MeasuredValue density;                           ///< [kg/m²]
  MeasuredValue thickness;                         ///< of the cloth itself, not of its contact [m]
  MeasuredValue extension_weft, extension_warp;    ///< EMT: strain at kExtensionLoad [1]
  MeasuredValue shear;                             ///< G: shear force per width / shear angle [N/m]
  MeasuredValue bend_weft, bend_warp;              ///< B: bending stiffness per width [N·m]
  MeasuredValue hysteresis;                        ///< HB / B: residual curvature after unloading [1/m]; HB: moment per
                                                   ///< width against a change of curvature [N]
  std::optional<std::pair<double, double>> drape;  ///< Cusick's drape coefficient: smallest and
                                                   ///< largest published value [1]
};

/// A named fabric: its measurements, and the material and finish that follow from them.
struct Fabric {
  Material material;  ///< contact thickness, friction, drag and viscosities are chosen; all other
                      ///< values follow from `measured`
  Measurements measured;
  Finish finish;       ///< chosen by fibre and weave, not measured
  bool frays;          ///< whether cut edges fray; they are then drawn with hems
  std::string what;    ///< weave and kind
  std::string source;  ///< publication of the measurements
};

/// kExtensionLoad: maximum load of the extension test of KES (500 gf/cm) [N/m]. kWornLoad: load of worn cloth (20
/// gf/cm, one of the loads of FAST) [N/m]; Material::stretch_weft and stretch_warp are the secant stiffnesses up to
/// this load.
inline constexpr double kExtensionLoad = 490.3, kWornLoad = 19.6;

/// Estimated thickness of cloth divided by its density [m per kg/m²]; measured: 0.0017 to 0.004.
inline constexpr double kThicknessPerDensity = 2.2e-3;

/// All fabrics. The first is the default; its material equals Material{}.
std::span<const Fabric> fabrics();
/// The fabric of this name; null if there is none.
const Fabric* find_fabric(std::string_view name);
std::vector<std::string> fabric_names();

}  // namespace weft::scene
