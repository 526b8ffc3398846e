#include "scene/fabrics.hpp"

#include <array>
#include <iterator>

// Conversions. KES (Kawabata, "The Standardization and Analysis of Hand Evaluation", 2nd ed., 1980):
//   bending     1 gf·cm²/cm    = 9.807e-5 N·m
//   shear       1 gf/(cm·deg)  = 56.2 N/m per radian; our mu is twice the shear modulus
//   extension   EMT is the strain at 500 gf/cm = 490.3 N/m, so the secant stiffness is 490.3 N/m / EMT
// FAST (Minazio, "FAST – Fabric Assurance by Simple Testing", Int. J. Clothing Sci. Tech. 7(2/3), 1995):
//   bending     B = 9.81e-6 W c³ µN·m, W in g/m², c the bending length in mm
//   shear       G = 123 / EB5 N/m, EB5 the bias extension in percent
//   extension   E100 is the strain at 100 gf/cm = 98.07 N/m
// Cantilever rule (Peirce, "The 'Handle' of Cloth as a Measurable Quantity", J. Textile Inst. 21, 1930): a strip that
// overhangs by two bending lengths c droops to 41.5°, and B = density * g * c³.
// Drape coefficients (Cusick's test): where no measured bending was at hand B was first taken from one, treating the
// overhang as a strip. A whole disc folds and is much stiffer: simulated (tests/validation/cusick_slow.cpp), silk came
// to 65 and leather to 87 %, and the B of both is now a quarter of that, chosen so that the simulated drape is in the
// band. Cotton, simulated 87 %, was left as it is, a firm sheeting. The bands of silk, cotton and denim are the
// calibration targets of ZOZO's ppf-contact-solver; that of leather is measured (see its note).
//
// How far the sources go: only denim and leather rest on published measurements that we have read, in the table and the
// abstract named in their notes. No published figures stand behind cotton, silk and jersey, and none that is reviewed
// behind wool. Kawabata, Minazio and Peirce are cited for the methods, not for figures of any fabric.
//
// Chosen by us for every fabric: friction (cloth on cloth is usually given as 0.2 to 0.6), contact thickness (several
// times the fabric's own, which is below what contact can resolve), drag, and the damping of bending: a viscosity, and
// what KES calls hysteresis, the dry friction between yarns. Stretch and shear have none: implicit Euler already damps
// them like a viscosity of half a time step times the stiffness.

namespace weft::scene {

namespace {

// Bending viscosity over bending stiffness [s]: yarns rubbing on each other damp a fold within about this time.
constexpr double kBendingTime = 0.1;
// Bending friction over bending stiffness [1/m], the curvature that a fold may keep for ever: a radius of 25 cm. KES
// figures of woven fabrics, with 2HB about half of B in gf·cm, are several times that.
constexpr double kResidualCurvature = 4;

struct Figures {
  double density, stretch_weft, stretch_warp, shear, bend, thickness, friction;
};

Fabric fabric(const char* name, const Figures& figures, const char* note) {
  Material material;
  material.fabric = name;
  material.density = figures.density;
  material.stretch_weft = figures.stretch_weft;
  material.stretch_warp = figures.stretch_warp;
  material.shear = figures.shear;
  material.bend = figures.bend;
  material.bend_viscosity = kBendingTime * figures.bend;
  material.bend_friction = kResidualCurvature * figures.bend;
  material.thickness = figures.thickness;
  material.friction = figures.friction;
  return {material, note};
}

}  // namespace

std::span<const Fabric> fabrics() {
  // Order: density [kg/m²], stretch weft, warp [N/m], shear mu [N/m], bend B [N·m], contact thickness [m], friction.
  static const std::array kFabrics = {
      Fabric{
          Material{},
          "firm plain sheeting; bending length 29 mm, where 20 mm would drape by 60 to 76 %; stretch at the lower end "
          "of woven fabrics (1e3 to 1e4 N/m), which keeps time steps cheap; all chosen by us"},
      fabric("silk", {0.07, 2000, 2000, 40, 1e-6, 0.001, 0.2},
             "light dress silk; bending length 11 mm for a simulated drape coefficient of 20 to 40 %; the rest chosen "
             "by us"),
      fabric(
          "wool", {0.22, 1700, 2100, 80, 1.2e-5, 0.002, 0.35},
          "worsted suiting, bending length 18 mm; stretch 98.07 N/m at E100 of 5.9 and 4.6 %, measured on one wool of "
          "168 g/m² in a student's FAST report (Fabric Assurance by Simple Testing, bartleby.com, 2014; not reviewed); "
          "that wool has B of 5.0e-6 and 5.6e-6 N·m and G of 26 N/m, and our heavier one, chosen by us, twice the "
          "bending and 1.5 times the shear"),
      fabric(
          "denim", {0.4, 5000, 5000, 250, 6e-5, 0.0025, 0.45},
          "shear inside the KES range of six denims, 1.5 to 3.4 gf/(cm·deg) = 84 to 191 N/m (Regenerated "
          "Cellulose-Based Denim Fabric for Tropical Regions, J. Textiles 2016, 4614168, Table 5); their bending, 0.14 "
          "to 0.23 gf·cm²/cm = 1.4e-5 to 2.2e-5 N·m, is that of light denim and ours is three times it for a drape "
          "coefficient of 70 to 90 %; their EMT of 4.7 to 5.7 % gives 8600 to 10400 N/m, and we took half for cheaper "
          "time steps; density chosen by us"),
      fabric(
          "leather", {0.5, 4000, 4000, 600, 2.5e-5, 0.003, 0.5},
          "sheep garment leather 0.64 to 0.96 mm thick with a drape coefficient of 47 to 70 % (Memon et al., Study on "
          "Effect of Leather Rigidity and Thickness on Drapability of Sheep Garment Leather, Materials 14(16) 4553, "
          "2021), bending length 17 mm for a simulated one of that; the rest chosen by us"),
      fabric("jersey", {0.18, 200, 300, 60, 5e-6, 0.002, 0.35},
             "single jersey knit: a tenth of the stiffness of woven fabrics; bending length 14 mm; all chosen by us"),
  };
  return kFabrics;
}

const Fabric* find_fabric(std::string_view name) {
  for (const Fabric& fabric : fabrics()) {
    if (fabric.material.fabric == name) return &fabric;
  }
  return nullptr;
}

std::vector<std::string> fabric_names() {
  std::vector<std::string> names;
  for (const Fabric& fabric : fabrics()) names.push_back(fabric.material.fabric);
  return names;
}

}  // namespace weft::scene
