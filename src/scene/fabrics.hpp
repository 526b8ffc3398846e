// Fabrics by name, from what was measured of cloth.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// A figure, and whether it was measured or follows from the rules of fabrics.cpp for what was not.
struct Figure {
  double value = 0;
  bool estimated = false;
};

/// What textile laboratories measure of a fabric.
struct Measurements {
  Figure density;                         ///< [kg/m²]
  Figure thickness;                       ///< of the cloth itself [m]
  Figure extension_weft, extension_warp;  ///< at 490 N/m, the largest load of KES (its EMT) [1]
  Figure shear;                           ///< G, shear force per width over shear angle [N/m]
  Figure bend_weft, bend_warp;            ///< B [N·m]
  Figure hysteresis;                      ///< HB / B, the curvature that is left when the moment is let go [1/m]
  std::optional<std::pair<double, double>> drape;  ///< Cusick's coefficient, least and most that was published [1]
};

struct Fabric {
  Material material;  ///< its `fabric` is the name; made of `measured`
  Measurements measured;
  Finish finish;       ///< chosen by us, by fibre and weave
  bool frays;          ///< where it is cut, which is why it is hemmed
  std::string what;    ///< weave and kind
  std::string source;  ///< of its figures
};

/// Load of a KES test of extension, 500 gf/cm, and that up to which `stretch` is the secant, FAST's 20 gf/cm [N/m].
inline constexpr double kExtensionLoad = 490.3, kWornLoad = 19.6;

/// All named fabrics; the first is the default and equals Material{}.
std::span<const Fabric> fabrics();
const Fabric* find_fabric(std::string_view name);
std::vector<std::string> fabric_names();

}  // namespace weft::scene
