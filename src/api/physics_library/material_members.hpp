// For each value of a material: its member in weft::Material, its member in model::Material, and its bounds.
#pragma once

#include <array>
#include <weft/model.hpp>

#include "physics/model/material.hpp"

namespace weft::library {

struct MaterialMember {
  double Material::*given;
  double model::Material::*physics;
  double low, high;  ///< allowed range, as in scenes (src/film/scene/material_rules.cpp)
  const char* what;  ///< name and unit of the value, for messages
};

inline constexpr double kAboveZero = 1e-12;  ///< lower bound of values for which scenes require > 0
inline constexpr std::array kMaterialMembers = std::to_array<MaterialMember>({
    {&Material::density, &model::Material::density, kAboveZero, 1e5, "a density [kg/m²]"},
    {&Material::stretch_weft, &model::Material::stretch_weft, 0, 1e12, "a stretch_weft [N/m]"},
    {&Material::stretch_warp, &model::Material::stretch_warp, 0, 1e12, "a stretch_warp [N/m]"},
    {&Material::shear, &model::Material::shear, 0, 1e12, "a shear [N/m]"},
    {&Material::bend, &model::Material::bend, 0, 1e6, "a bend [N·m]"},
    {&Material::max_stretch, &model::Material::max_stretch, 0, 10, "a max_stretch"},
    {&Material::max_shear, &model::Material::max_shear, 0, 80, "a max_shear [degrees]"},
    {&Material::stretch_viscosity, &model::Material::stretch_viscosity, 0, 1e9, "a stretch_viscosity [N·s/m]"},
    {&Material::shear_viscosity, &model::Material::shear_viscosity, 0, 1e9, "a shear_viscosity [N·s/m]"},
    {&Material::bend_viscosity, &model::Material::bend_viscosity, 0, 1e6, "a bend_viscosity [N·m·s]"},
    {&Material::bend_friction, &model::Material::bend_friction, 0, 1e6, "a bend_friction [N]"},
    {&Material::thickness, &model::Material::thickness, kAboveZero, 1, "a thickness [m]"},
    {&Material::friction, &model::Material::friction, 0, 10, "a friction"},
    {&Material::drag, &model::Material::drag, 0, 100, "a drag"},
});

}  // namespace weft::library
