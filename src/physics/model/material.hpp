// Physical properties of a fabric.
#pragma once

#include <string>

namespace weft::model {

/// A fabric; the values do not depend on the mesh (Etzmuß et al. 2001, "Elastic Model").
struct Material {
  std::string fabric = "cotton";  ///< name of the fabric that supplies the values that a scene does not give
  double density = 0.15;          ///< [kg/m²]
  double stretch_weft = 800;      ///< k1: stiffness along weft [N/m]
  double stretch_warp = 2100;     ///< k2: stiffness along warp [N/m]
  double shear = 130;             ///< mu: shear stiffness [N/m]; the shear modulus of linear elasticity is mu / 2
  double bend = 1e-5;             ///< B: bending stiffness [N·m]
  double max_stretch = 0.1;       ///< extension at which threads lock (stiffen) [1]; 0: never
  double max_shear = 0;           ///< change of the weft-warp angle at which threads lock [degrees]; 0: never
  double stretch_viscosity = 0;   ///< stress per strain rate, weft and warp [N·s/m]
  double shear_viscosity = 0;     ///< [N·s/m]
  double bend_viscosity = 1e-6;   ///< [N·m·s]
  double bend_friction = 5e-4;    ///< bending moment per width below which the curvature does not change [N]
  double thickness = 0.002;       ///< contact distance between two sheets of this fabric [m]
  double friction = 0.3;          ///< Coulomb coefficient; contacts use the geometric mean of both coefficients
  double drag = 1.0;              ///< air resistance coefficient, for motion normal to the cloth; 0: none

  /// Whether cloth of this material resists bending. If not, bending viscosity and bending friction have no effect.
  bool bends() const { return bend > 0; }
  /// Whether this material has a limit to stretch or shear, at which its threads lock.
  bool locks() const { return max_stretch > 0 || max_shear > 0; }
};

}  // namespace weft::model
