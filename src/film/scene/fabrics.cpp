#include "film/scene/fabrics.hpp"

#include <array>
#include <cmath>

// Units of the test methods. KES (Kawabata, "The Standardization and Analysis of Hand Evaluation", 2nd ed., 1980):
//   bending     B: 1 gf·cm²/cm = 98.07 µN·m; 2HB: 1 gf·cm/cm = 9.807 mN
//   shear       G: 1 gf/(cm·deg) = 56.2 N/m per radian; Material::shear is 2 G
//   extension   EMT is the strain at 500 gf/cm = 490.3 N/m; the linearity LT is 2 / (n + 1) if the force is
//               proportional to strainⁿ
// FAST (Minazio, "FAST – Fabric Assurance by Simple Testing", Int. J. Clothing Sci. Tech. 7(2/3), 1995):
//   shear       G = 123 / EB5 N/m; EB5 is the bias extension in percent
//   extension   E5, E20 and E100 are the strains at 4.9, 19.6 and 98.07 N/m
//
// How measurements become a Material, for all fabrics:
//   stretch      the secant stiffness up to 19.6 N/m, the load of worn and hanging cloth. For fabrics with threads, the
//                force is assumed to be proportional to strain²: then LT is 2/3 (measured: 0.50 to 0.60 for suitings,
//                0.66 to 0.78 for denims), and the secant is 98.0 N/m / EMT. For fabrics without threads, the force
//                is assumed to be proportional to strain, and the secant is 490.3 N/m / EMT.
//   max_stretch  the limit of forces::Lock, chosen so that the forces of `stretch` and of the lock
//                add up to 490 N/m at the mean EMT of weft and warp.
//   shear        2 G
//   bend         √(weft · warp), since a Material has one bending stiffness for all directions
//   bend_friction   HB
//   These values are rounded to two digits, because none is known more precisely.
//
// Quantities without a measurement are estimated from fibre, weave and weight:
//   bend         130 µN·m (density / 1 kg/m²)^1.35. This is within 13 % of the medians of 251 fabrics, measured by
//                cantilever, in nine classes of weight from 30 to 490 g/m² (data set of Feng et al., "Learning-Based
//                Bending Stiffness Parameter Estimation by a Drape Tester", 2022). Softer or firmer fabrics use
//                another quantile of their class (Hand). For weaves, the ratio of warp to weft is
//                1.4, the median of the data; for other fabrics, it is 1.
//   hysteresis   HB / B: cotton 50, wool 25, filaments 18 m⁻¹; measured: 53 and 43 m⁻¹ for broadcloth and denim,
//                25 m⁻¹ for a tropical (light worsted wool), 19 and 18 m⁻¹ for polyesters
//   shear        G: cotton 65, wool 26, filaments and knits 30 N/m; measured for plain weaves:
//                cotton 65, wool 24 to 26, filaments 30. Fabrics without threads: an isotropic
//                sheet with Poisson's ratio 0.3. For faille alone, G is fitted to the published
//                drape: 7.5 N/m.
//   extension    EMT: weaves 8 and 5 % along weft and warp (measured: 5 to 13, 4 to 10), knits 60 and 25 %, fabrics
//                without threads 12 %
//   thickness    kThicknessPerDensity
//
// Not measured but chosen are: friction (published for cloth on cloth: usually 0.2 to 0.6), contact thickness (several
// times the thickness of the fabric, because contact cannot resolve the thickness itself), drag, and viscosity of
// bending. Stretch and shear have no viscosity, because implicit Euler already damps them as much as a viscosity of
// half a time step times the stiffness would.

namespace weft::scene {

namespace {

// Bending viscosity divided by bending stiffness [s]: about the time in which a fold without inertia opens.
constexpr double kBendingDampingTime = 0.1;

enum class Fibre { cotton, wool, filament };
enum class Weave { woven, knitted, none };
/// Bending stiffness compared with measured fabrics of the same weight: their 10, 25, 50, 75 or 90 % quantile.
enum class Hand { limp, soft, usual, firm, stiff };

using Measured = std::optional<double>;
using Pair = std::optional<std::pair<double, double>>;

/// Published values of a fabric. Absent values are estimated.
struct Row {
  const char* name;
  const char* what;
  const char* source;
  MeasuredValue density;  // [g/m²]
  Fibre fibre = Fibre::cotton;
  Hand hand = Hand::usual;
  Weave weave = Weave::woven;
  Measured thickness = {};     // [mm]
  Pair extension = {};         // EMT of weft and warp [%]
  Measured shear = {};         // G [N/m]
  Pair bend = {};              // B of weft and warp [µN·m]; equal if only their mean is published
  Measured fitted_shear = {};  // G fitted to the published drape [N/m]; used without `shear`
  Measured hysteresis = {};    // HB / B [1/m]
  Pair drape = {};             // minimum and maximum of Cusick's coefficient [%]
  double contact = 2;          // contact thickness [mm]
  double friction = 0.3;
  std::optional<Finish> finish = {};  // if absent, that of the fibre
};

constexpr const char* kMatsudaira =
    "Matsudaira et al., J. Textile Eng. 61(6), 2015, tables 1 and 2, as transcribed in 3fold-motion-engine";
constexpr const char* kNone = "none found: all estimated";

// The fabrics, in the order of the documentation: cotton and similar fibres, wool, filaments, leather.
constexpr Row kRows[] = {
    {.name = "cotton",
     .what = "light plain weave",
     .source =
         "Penava et al., 2014, tables 1 and 3, as transcribed in Codim-IPC; drape: one plain weave with 18.5 to 32 "
         "picks/cm, VaT 2018(1), and Gan et al., 1991",
     .density = {150},
     .thickness = 0.318,
     .extension = {{12.3, 4.7}},
     .shear = 65,
     .drape = {{48, 72}}},
    {.name = "poplin",
     .what = "cotton broadcloth",
     .source = kMatsudaira,
     .density = {124},
     .thickness = 0.497,
     .bend = {{11.6, 11.6}},
     .hysteresis = 53,
     .drape = {{82.9, 82.9}}},
    {.name = "denim",
     .what = "12 oz cotton twill",
     .source = "KES of six denims, J. Textiles 2016, 4614168, table 5, without weights: EMT 4.7 to 5.7 %, G 1.5 to 3.4 "
               "gf/(cm·deg); their B, 14 to 22 µN·m, is that of light ones",
     .density = {400, true},
     .hand = Hand::firm,
     .thickness = 1.0,
     .extension = {{5.2, 5.2}},
     .shear = 129,
     .hysteresis = 43,
     .drape = {{70, 90}},
     .contact = 2.5,
     .friction = 0.45,
     .finish = Finish{0.06, 0.7, 0.35, 0.04, Threads::denim}},
    {.name = "canvas",
     .what = "cotton duck",
     .source = "weight and thickness in Codim-IPC, which names no source",
     .density = {294},
     .hand = Hand::stiff,
     .thickness = 0.53,
     .contact = 2.5,
     .friction = 0.4,
     .finish = Finish{0.05, 0.5, 0.35, 0.06}},
    {.name = "linen",
     .what = "shirt weight plain weave",
     .source = kNone,
     .density = {170, true},
     .hand = Hand::firm,
     .finish = Finish{0.2, 0.5, 0.3, 0.2}},
    {.name = "jersey",
     .what = "single jersey knit",
     .source = "drape: jerseys of 25 cm, VaT 2018(1), which 30 cm would lower",
     .density = {180, true},
     .hand = Hand::limp,
     .weave = Weave::knitted,
     .drape = {{18, 31}},
     .friction = 0.35,
     .finish = Finish{0.08, 0.5, 0.55, 0.22, Threads::knit}},
    {.name = "wool",
     .what = "tropical, a light plain worsted",
     .source = "Matsudaira et al., as poplin; extension and shear of another, 168 g/m², from a student's FAST report "
               "(bartleby.com, 2014): E100 5.9 and 4.6 %, B 5.0 and 5.6 µN·m",
     .density = {163},
     .fibre = Fibre::wool,
     .thickness = 0.407,
     .extension = {{13.1, 10.3}},
     .shear = 26,
     .bend = {{6.6, 6.6}},
     .hysteresis = 25,
     .drape = {{49.8, 49.8}},
     .friction = 0.35},
    {.name = "suiting",
     .what = "worsted wool for suits",
     .source = "Penava et al., as cotton; inside of the band of Fan, Yu & Hunter, 2004, table 1.12",
     .density = {235},
     .fibre = Fibre::wool,
     .thickness = 0.568,
     .extension = {{10.7, 4.0}},
     .shear = 24,
     .drape = {{40, 70}},
     .friction = 0.35,
     .finish = Finish{0.12, 0.6, 0.7, 0.06, Threads::twill}},
    {.name = "felt",
     .what = "pressed wool, 1 mm",
     .source = kNone,
     .density = {250, true},
     .fibre = Fibre::wool,
     .hand = Hand::stiff,
     .weave = Weave::none,
     .contact = 3,
     .friction = 0.5,
     .finish = Finish{0, 0.5, 1, 0.03, Threads::none}},
    {.name = "silk",
     .what = "light dress silk",
     .source = "weight and thickness in Codim-IPC, which names no source; drape: target of ZOZO's ppf-contact-solver",
     .density = {83},
     .fibre = Fibre::filament,
     .hand = Hand::limp,
     .thickness = 0.18,
     .drape = {{20, 40}},
     .contact = 1,
     .friction = 0.2,
     .finish = Finish{0.7, 0.6, 0.1, 0.3}},
    {.name = "satin",
     .what = "five-thread satin",
     .source = "weight and drape of those of 186 to 304 g/m², VaT 2018(1)",
     .density = {186},
     .fibre = Fibre::filament,
     .hand = Hand::soft,
     .drape = {{43, 70}},
     .friction = 0.2,
     .finish = Finish{1, 0.85, 0.05, 0.15}},
    {.name = "chiffon",
     .what = "sheer plain weave, 8 momme",
     .source = kNone,
     .density = {35, true},
     .fibre = Fibre::filament,
     .hand = Hand::soft,
     .contact = 1,
     .friction = 0.25,
     .finish = Finish{0.3, 0.5, 0.2, 0.9}},
    {.name = "polyester",
     .what = "tropical, plain weave",
     .source = kMatsudaira,
     .density = {117},
     .fibre = Fibre::filament,
     .thickness = 0.340,
     .bend = {{7.6, 7.6}},
     .hysteresis = 19,
     .drape = {{50.7, 50.7}},
     .friction = 0.25},
    {.name = "faille",
     .what = "fluid ribbed polyester",
     .source = kMatsudaira,
     .density = {104},
     .fibre = Fibre::filament,
     .thickness = 0.226,
     .bend = {{1.9, 1.9}},
     .fitted_shear = 7.5,
     .hysteresis = 18,
     .drape = {{28.3, 28.3}},
     .contact = 1,
     .friction = 0.25},
    {.name = "ripstop",
     .what = "nylon of flags and parachutes",
     .source = "weight and thickness: specification of nylon 7020 II",
     .density = {54},
     .fibre = Fibre::filament,
     .hand = Hand::firm,
     .thickness = 0.10,
     .contact = 1,
     .friction = 0.2,
     .finish = Finish{0.5, 0.5, 0.05, 0.5}},
    {.name = "leather",
     .what = "sheep garment leather",
     .source = "thickness and drape: Memon et al., Materials 14(16) 4553, 2021",
     .density = {500, true},
     .fibre = Fibre::filament,
     .hand = Hand::soft,
     .weave = Weave::none,
     .thickness = 0.80,
     .drape = {{47.4, 69.9}},
     .contact = 3,
     .friction = 0.5,
     .finish = Finish{0.35, 0.5, 0.1, 0, Threads::none}},
};

// The finish of a row or, if it is absent, that of its fibre: cotton scatters light, wool is fuzzy, filaments are
// glossy.
Finish finish_of(const Row& row) {
  if (row.finish) return *row.finish;
  return row.fibre == Fibre::cotton ? Finish{0.1, 0.5, 0.4, 0.2}
         : row.fibre == Fibre::wool ? Finish{0.06, 0.5, 0.85, 0.1}
                                    : Finish{0.4, 0.5, 0.12, 0.2};
}

// Rounds a positive value to two significant digits.
double two_digits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  // Divides integers, because their quotient is rounded correctly: the result is the double that a text such as "0.015"
  // gives.
  return unit < 1 ? std::round(value / unit) / std::round(1 / unit) : std::round(value / unit) * unit;
}

// The measured value times `unit`, else `estimate`.
template <class Value>
constexpr MeasuredValue known_or(const std::optional<Value>& measured, double unit, double estimate) {
  return measured ? MeasuredValue{*measured * unit, false} : MeasuredValue{estimate, true};
}
constexpr std::pair<Measured, Measured> both(const Pair& pair) {
  if (!pair) return {};
  return {pair->first, pair->second};
}

double estimated_bend(const Row& row) {
  // The 10, 25, 50, 75 and 90 % quantiles of a class of weight, relative to the median of this class: means over the
  // nine classes.
  constexpr std::array kQuantiles{0.3, 0.55, 1.0, 1.5, 2.3};
  return kQuantiles[static_cast<std::size_t>(row.hand)] * 130e-6 * std::pow(1e-3 * row.density.value, 1.35);
}

double estimated_hysteresis(const Row& row) {
  return row.fibre == Fibre::cotton ? 50 : row.fibre == Fibre::wool ? 25 : 18;
}

std::pair<double, double> estimated_extension(const Row& row) {
  if (row.weave == Weave::none) return {0.12, 0.12};
  return row.weave == Weave::woven ? std::pair{0.08, 0.05} : std::pair{0.60, 0.25};
}

// Secant stiffness up to kWornLoad [N/m] for a strain `extension` at kExtensionLoad. See `stretch` above.
double secant_stiffness(Weave weave, double extension) {
  return (weave == Weave::none ? kExtensionLoad : std::sqrt(kExtensionLoad * kWornLoad)) / extension;
}

double estimated_shear(const Row& row) {
  if (row.weave == Weave::none) return secant_stiffness(row.weave, estimated_extension(row).first) / (2 * (1 + 0.3));
  if (row.weave == Weave::knitted) return 30;
  return row.fibre == Fibre::cotton ? 65 : row.fibre == Fibre::wool ? 26 : 30;
}

Measurements measurements(const Row& row) {
  const auto [extension_weft, extension_warp] = estimated_extension(row);
  const double bend = estimated_bend(row), skew = row.weave == Weave::woven ? std::sqrt(1.4) : 1;
  Measurements m;
  m.density = {row.density.value / 1000, row.density.estimated};
  m.thickness = known_or(row.thickness, 1e-3, kThicknessPerDensity * m.density.value);
  m.extension_weft = known_or(both(row.extension).first, 0.01, extension_weft);
  m.extension_warp = known_or(both(row.extension).second, 0.01, extension_warp);
  m.shear = known_or(row.shear, 1, row.fitted_shear.value_or(estimated_shear(row)));
  m.bend_weft = known_or(both(row.bend).first, 1e-6, bend / skew);
  m.bend_warp = known_or(both(row.bend).second, 1e-6, bend * skew);
  m.hysteresis = known_or(row.hysteresis, 1, estimated_hysteresis(row));
  if (row.drape) m.drape = {0.01 * row.drape->first, 0.01 * row.drape->second};
  return m;
}

// The max_stretch for which the force at the strain `extension` is kExtensionLoad. The lock exerts the part of this
// load that the secant stiffness does not exert.
double max_stretch_for(Weave weave, double extension) {
  constexpr double kOnset = 0.7, kTension = 4e3;  // constants of forces::Lock
  const double rest = kExtensionLoad - secant_stiffness(weave, extension) * extension;
  return extension / (kOnset + (1 - kOnset) * std::cbrt(rest / kTension));
}

Fabric fabric(const Row& row) {
  const Measurements m = measurements(row);
  const double bend = std::sqrt(m.bend_weft.value * m.bend_warp.value);
  Material material;
  material.fabric = row.name;
  material.density = m.density.value;
  material.stretch_weft = two_digits(secant_stiffness(row.weave, m.extension_weft.value));
  material.stretch_warp = two_digits(secant_stiffness(row.weave, m.extension_warp.value));
  material.max_stretch =
      two_digits(max_stretch_for(row.weave, 0.5 * (m.extension_weft.value + m.extension_warp.value)));
  material.shear = two_digits(2 * m.shear.value);
  material.bend = two_digits(bend);
  material.bend_viscosity = two_digits(kBendingDampingTime * bend);
  material.bend_friction = two_digits(m.hysteresis.value * bend);
  material.thickness = 1e-3 * row.contact;
  material.friction = row.friction;
  return {material, m, finish_of(row), row.weave != Weave::none, row.what, row.source};
}

}  // namespace

std::span<const Fabric> fabrics() {
  static const std::vector<Fabric> kFabrics = [] {
    std::vector<Fabric> made;
    for (const Row& row : kRows) made.push_back(fabric(row));
    return made;
  }();
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
