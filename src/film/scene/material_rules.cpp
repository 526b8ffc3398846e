#include "film/scene/material_rules.hpp"

#include <fmt/format.h>

#include "film/scene/common_rules.hpp"
#include "film/scene/fabrics.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::scene {

namespace {

// Documentation of the key `fabric`. It names the fabrics whose bending is measured.
std::string fabric_documentation() {
  std::vector<std::string> measured, estimated;
  for (const Fabric& fabric : fabrics())
    (fabric.measured.bend_weft.estimated ? estimated : measured).push_back(fabric.material.fabric);
  return fmt::format(
      "named fabric, which gives every value that is not written here; bending is measured for {}, and estimated for "
      "the others from weight, fibre and weave",
      fmt::join(measured, ", "));
}

}  // namespace

const Table& material_rules() {
  const std::string of_fabric = "that of the fabric";
  static const Table kTable =
      TableBuilder<Material>("The fabric: by name, by numbers, or by name with some numbers changed.")
          .choice_by(
              "fabric", fabric_names(), fabric_documentation(),
              [](Material& m) { return static_cast<std::size_t>(find_fabric(m.fabric) - fabrics().data()); },
              [](Material& m, std::size_t index) { m = fabrics()[index].material; })
          .number("density", &Material::density, above(0, 1e5), "kg/m²", "mass per area")
          .by_default(of_fabric)
          .pair("stretch", &Material::stretch_weft, &Material::stretch_warp, within(0, 1e12), "N/m",
                "stiffness against stretch along weft and warp (k1, k2)")
          .by_default(of_fabric)
          .number("shear", &Material::shear, within(0, 1e12), "N/m",
                  "stiffness against shear (mu); twice the shear modulus of linear elasticity")
          .by_default(of_fabric)
          .number("bend", &Material::bend, within(0, 1e6), "N·m",
                  "bending rigidity (B); 0: no resistance to bending, bend_viscosity and bend_friction included")
          .by_default(of_fabric)
          .number("max_stretch", &Material::max_stretch, within(0, 10), "",
                  "extension at which threads lock, 0.1 for 10 %; they stiffen from 0.7 times this extension on and "
                  "hardly stretch beyond it; 0: no limit")
          .by_default(of_fabric)
          .number("max_shear", &Material::max_shear, within(0, 80), "degrees",
                  "deviation from the right angle between weft and warp at which they lock, likewise; 0: no limit")
          .by_default(of_fabric)
          .number("stretch_viscosity", &Material::stretch_viscosity, within(0, 1e9), "N·s/m",
                  "viscous stress per rate of stretch along weft and warp")
          .by_default(of_fabric)
          .number("shear_viscosity", &Material::shear_viscosity, within(0, 1e9), "N·s/m",
                  "viscous stress per rate of shear")
          .by_default(of_fabric)
          .number("bend_viscosity", &Material::bend_viscosity, within(0, 1e6), "N·m·s",
                  "viscous moment per width and rate of curvature")
          .by_default(of_fabric)
          .number("bend_friction", &Material::bend_friction, within(0, 1e6), "N",
                  "moment per width that a change of curvature must overcome (half of 2HB of the KES test)")
          .by_default(of_fabric)
          .number("thickness", &Material::thickness, above(0, 1), "m",
                  "distance that contact keeps between two layers; limited to a quarter of the particle spacing")
          .by_default(of_fabric)
          .number("friction", &Material::friction, within(0, 10), "", kFrictionOfBoth)
          .by_default(of_fabric)
          .number("drag", &Material::drag, within(0, 100), "",
                  "drag coefficient of motion along the normal; 0: no air resistance")
          .by_default(of_fabric)
          .build();
  return kTable;
}

}  // namespace weft::scene
