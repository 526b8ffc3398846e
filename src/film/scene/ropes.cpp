#include "film/scene/ropes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/catmull_rom.hpp"

namespace weft::scene {
namespace {

constexpr double kStandardGravity = 9.81;  // [m/s²]; the weight in RopeMaterial::bending_length refers to it
constexpr double kRopePiece = 3;           // default length of a piece [diameters]
constexpr int kMinRopePieces = 4;          // minimum number of pieces that the program chooses
constexpr int kSplinePieces = 16;          // number of lines that approximate a spline between two points
constexpr int kCatenaryPieces = 512;       // number of lines that approximate a catenary

// A polyline along the points of a rope. If the rope is closed, the polyline ends at the first point.
std::vector<Vec3> path_through(const Rope& rope) {
  const std::vector<Vec3>& points = rope.points;
  const auto count = static_cast<int>(points.size()), spans = rope.closed ? count : count - 1;
  const int pieces = rope.smooth ? kSplinePieces : 1;
  std::vector<Vec3> path{points[0]};
  for (int i = 0; i < spans; ++i)
    for (int k = 1; k <= pieces; ++k)
      path.push_back(spline_point(points, rope.closed, i, static_cast<double>(k) / pieces));
  return path;
}

// A catenary between two ends, as a polyline. `length`: of the catenary [m]; `up`: unit vector.
std::vector<Vec3> catenary(const Vec3& from, const Vec3& to, double length, const Vec3& up) {
  const Vec3 chord = to - from;
  const double rise = up.dot(chord);
  const Vec3 along = chord - rise * up;
  const double span = along.norm();
  // Solves sinh(u) / u = ratio by bisection. The catenary parameter a = span / (2 u) is the ratio of the horizontal
  // tension to the weight per length [m].
  const double ratio = std::sqrt(length * length - rise * rise) / span;
  if (ratio <= 1) return {from, to};  // the length exceeds the chord only by rounding errors
  double low = 0, high = 1;
  while (std::sinh(high) / high < ratio) high *= 2;
  for (int k = 0; k < 100; ++k) {
    const double u = 0.5 * (low + high);
    (std::sinh(u) / u < ratio ? low : high) = u;
  }
  const double a = span / (low + high), lowest = 0.5 * span - a * std::atanh(rise / length);
  std::vector<Vec3> path;
  for (int k = 0; k <= kCatenaryPieces; ++k) {
    const double s = length * k / kCatenaryPieces;
    const double x = lowest + a * std::asinh(s / a - std::sinh(lowest / a));
    const double z = a * (std::cosh((x - lowest) / a) - std::cosh(lowest / a));
    path.emplace_back(from + x / span * along + z * up);
  }
  path.back() = to;
  return path;
}

// Points that divide a polyline into `pieces` pieces of equal length, both ends included.
std::vector<Vec3> resample(const std::vector<Vec3>& path, int pieces) {
  std::vector<double> arc_lengths{0};
  for (std::size_t k = 1; k < path.size(); ++k)
    arc_lengths.push_back(arc_lengths.back() + (path[k] - path[k - 1]).norm());
  std::vector<Vec3> places;
  std::size_t span = 1;
  for (int i = 0; i < pieces; ++i) {
    const double s = arc_lengths.back() * i / pieces;
    while (span + 1 < path.size() && arc_lengths[span] < s) ++span;
    const double length = arc_lengths[span] - arc_lengths[span - 1];
    places.emplace_back(path[span - 1] +
                        (length > 0 ? (s - arc_lengths[span - 1]) / length : 0) * (path[span] - path[span - 1]));
  }
  places.push_back(path.back());
  return places;
}

// Rest length at the start [m], as the scene gives it: `length` or, without it, the length of the first key frame.
// nullopt if the scene gives neither; the rest length is then that of the start shape.
std::optional<double> start_length(const Rope& rope) {
  if (rope.length || rope.keys.empty()) return rope.length;
  return rope.keys.front().length;
}

}  // namespace

// Mass and stiffness of nylon, polyester, polypropylene and steel (wire with a fibre core) are from formulas for
// mooring ropes, as transcribed in ddjokic/Mooring-Line-Properties (moorwire.py). For comparison: according to data
// sheets of Robline, ropes of 10 mm have a mass of 680 kg/m per m² (polyester) or 430 (polypropylene). The values of
// cotton and all bending lengths are estimates, based on a limp line of 6 mm with a bending length of 9 cm.
const std::vector<RopeMaterial>& rope_materials() {
  static const std::vector<RopeMaterial> kMaterials = {
      {"cotton", 650, 2.5e8, 15},         {"nylon", 676, 1.18e8, 15},   {"polyester", 798, 1.09e9, 15},
      {"polypropylene", 453, 1.06e9, 15}, {"steel", 3611, 3.67e10, 40},
  };
  return kMaterials;
}

RopeNumbers numbers_of(const Rope& rope) {
  const auto& material = rope_materials()[static_cast<std::size_t>(rope.material)];
  const double square = rope.diameter * rope.diameter;
  RopeNumbers numbers{};
  numbers.mass = rope.mass.value_or(material.mass * square);
  numbers.stretch = rope.stretch.value_or(material.stretch * square);
  numbers.bend = rope.bend.value_or(material.mass * square * kStandardGravity *
                                    std::pow(material.bending_length * rope.diameter, 3));
  return numbers;
}

bool hangs_slack(const Rope& rope) {
  return rope.points.empty() && start_length(rope).value_or(0) > (*rope.to - *rope.from).norm();
}

RopeShape start_shape(const Rope& rope, UpAxis up) {
  const std::optional<double> wanted = start_length(rope);
  std::vector<Vec3> path;
  if (!rope.points.empty())
    path = path_through(rope);
  else if (hangs_slack(rope))
    path = catenary(*rope.from, *rope.to, *wanted, up_vector(up));
  else
    path = {*rope.from, *rope.to};
  double length = 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  const int pieces = rope.segments.value_or(std::max(
      kMinRopePieces, static_cast<int>(std::min(1e6, wanted.value_or(length) / (kRopePiece * rope.diameter)))));
  RopeShape shape{resample(path, pieces), {}};
  double chords = 0;
  for (std::size_t k = 1; k < shape.places.size(); ++k) {
    shape.lengths.push_back((shape.places[k] - shape.places[k - 1]).norm());
    chords += shape.lengths.back();
  }
  if (wanted)
    for (double& piece : shape.lengths) piece *= *wanted / chords;
  if (rope.closed) shape.places.pop_back();
  return shape;
}

Cloth as_cloth(const Rope& rope) {
  Cloth cloth;
  cloth.name = rope.name;
  cloth.shape = ClothShape::rope;
  cloth.rope = std::make_shared<const Rope>(rope);
  cloth.sewing = 0;
  cloth.velocity = rope.velocity;
  Material& material = cloth.material;
  material.density = material.stretch_weft = material.stretch_warp = material.shear = material.bend = 0;
  material.max_stretch = material.bend_viscosity = material.bend_friction = 0;
  material.thickness = rope.diameter;
  material.friction = rope.friction;
  material.drag = rope.drag;
  cloth.look = rope.look;
  cloth.pins = rope.pins;
  cloth.weights = rope.weights;
  return cloth;
}

void add_rope_cloths(Scene& scene) {
  for (const Rope& rope : scene.ropes) scene.cloths.push_back(as_cloth(rope));
}

void remove_rope_cloths(Scene& scene) {
  std::erase_if(scene.cloths, [](const Cloth& cloth) { return cloth.rope != nullptr; });
}

}  // namespace weft::scene
