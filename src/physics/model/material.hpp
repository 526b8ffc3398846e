// Physical properties of a fabric.
#pragma once

#include <string>

namespace weft::model {

/// A fabric; the values do not depend on the mesh (Etzmuß et al. 2001, "Elastic Model").
struct Material {
  std::string fabric = "cotton";  ///< name of the fabric from which the scene took the values below by default
  double density = 0.15;          ///< [kg/m²]
  double stretch_weft = 800;      ///< k1: stiffness along weft [N/m]
  double stretch_warp = 2100;     ///< k2: stiffness along warp [N/m]
  double shear = 130;             ///< mu: shear stiffness [N/m], twice the shear modulus of linear elasticity
  double bend = 1e-5;             ///< B: bending stiffness [N·m]
  double max_stretch = 0.1;       ///< extension at which threads lock (stiffen) [1]; 0: never
  double max_shear = 0;           ///< deviation of the angle between weft and warp from 90° at
                                  ///< which threads lock [degrees]; 0: never
  double stretch_viscosity = 0;   ///< force per width and strain rate, along weft and along warp [N·s/m]
  double shear_viscosity = 0;     ///< force per width and rate of shear [N·s/m]
  double bend_viscosity = 1e-6;   ///< moment per width and rate of curvature [N·m·s]
  double bend_friction = 5e-4;    ///< moment per width against a change of curvature [N]
  double thickness = 0.002;       ///< distance at which two sheets of this fabric begin to push
                                  ///< each other [m]; limited by
                                  ///< Numerics::Contact::thickness_of_spacing
  double friction = 0.3;          ///< Coulomb coefficient; a contact uses the geometric mean of both sides
  double drag = 1.0;              ///< drag coefficient, for motion normal to the cloth; 0: no air resistance

  /// Whether a sheet of this material resists bending. If not, bending viscosity and bending
  /// friction have no effect either. (Ropes bend by model::Rope::bend.)
  bool resists_bending() const { return bend > 0; }
  /// Whether this material has a limit of stretch or shear, at which its threads lock.
  bool has_strain_limit() const { return max_stretch > 0 || max_shear > 0; }
};

}  // namespace weft::model
