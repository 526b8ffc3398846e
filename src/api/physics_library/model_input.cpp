#include "api/physics_library/model_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "physics/mesh/geometry.hpp"

namespace weft::library {
namespace {

template <class... Arguments>
[[noreturn]] void refuse(const std::string& object, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw std::invalid_argument(object + ": expected " + fmt::format(text, std::forward<Arguments>(arguments)...));
}

Vec3 vector_of(const Vector& x, const std::string& object, const char* what) {
  const Vec3 vector(x.data());
  if (!vector.allFinite()) refuse(object, "a finite {}, got [{}]", what, fmt::join(x, ", "));
  return vector;
}

void check_range(double value, double low, double high, const std::string& object, const char* what) {
  if (!(value >= low && value <= high)) refuse(object, "{} from {:g} to {:g}, got {:g}", what, low, high, value);
}

mesh::Mesh mesh_of(const Mesh& given, const std::string& object) {
  mesh::Mesh mesh;
  for (const Vector& x : given.positions) mesh.positions.push_back(vector_of(x, object, "position [m]"));
  for (const Triangle& t : given.triangles) mesh.topology.triangles.push_back({t[0], t[1], t[2]});
  if (mesh.topology.triangles.empty()) refuse(object, "at least one triangle, got none");
  const mesh::TopologyReport report = mesh::inspect(mesh.topology.triangles, mesh.positions.size());
  if (!report.manifold())
    refuse(
        object,
        "edges of one or two triangles that face the same way; got {} triangles with an index outside of 0 to {}, {} "
        "with a vertex twice, {} edges of more than two triangles, and {} whose triangles face both ways",
        report.out_of_range.size(), mesh.positions.size() - 1, report.degenerate.size(), report.non_manifold.size(),
        report.misoriented.size());
  return mesh;
}

model::Material material_of(const Material& given, const std::string& object) {
  constexpr double kLargest = 1e9;
  const auto nonnegative = [&](double value, const char* what) { check_range(value, 0, kLargest, object, what); };
  check_range(given.density, 1e-6, kLargest, object, "a density [kg/m²]");
  check_range(given.stretch_weft, 1e-6, kLargest, object, "a stretch_weft [N/m]");
  check_range(given.stretch_warp, 1e-6, kLargest, object, "a stretch_warp [N/m]");
  check_range(given.thickness, 1e-6, 1, object, "a thickness [m]");
  check_range(given.max_shear, 0, 90, object, "a max_shear [degrees]");
  nonnegative(given.shear, "a shear [N/m]");
  nonnegative(given.bend, "a bend [N·m]");
  nonnegative(given.max_stretch, "a max_stretch");
  nonnegative(given.stretch_viscosity, "a stretch_viscosity [N·s/m]");
  nonnegative(given.shear_viscosity, "a shear_viscosity [N·s/m]");
  nonnegative(given.bend_viscosity, "a bend_viscosity [N·m·s]");
  nonnegative(given.bend_friction, "a bend_friction [N]");
  nonnegative(given.friction, "a friction");
  nonnegative(given.drag, "a drag");
  model::Material material;
  material.density = given.density;
  material.stretch_weft = given.stretch_weft, material.stretch_warp = given.stretch_warp;
  material.shear = given.shear, material.bend = given.bend;
  material.max_stretch = given.max_stretch, material.max_shear = given.max_shear;
  material.stretch_viscosity = given.stretch_viscosity, material.shear_viscosity = given.shear_viscosity;
  material.bend_viscosity = given.bend_viscosity, material.bend_friction = given.bend_friction;
  material.thickness = given.thickness, material.friction = given.friction, material.drag = given.drag;
  return material;
}

model::Cloth cloth_of(const Cloth& given) {
  model::Cloth cloth;
  cloth.name = cloth.source = given.name;
  cloth.mesh = mesh_of(given.mesh, given.name);
  cloth.sheet = mesh::make_sheet_from_mesh(cloth.mesh);
  cloth.start = cloth.mesh.positions;
  if (!given.rest.empty()) {
    if (given.rest.size() != cloth.start.size())
      refuse(given.name, "as many rest points as particles ({}), got {}", cloth.start.size(), given.rest.size());
    for (const RestPoint& uv : given.rest) cloth.mesh.uv.emplace_back(uv[0], uv[1]);
    cloth.sheet.sewn = true;  // the flat fabric is the rest shape from the first step on
    for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        cloth.sheet.material[t][k] = cloth.mesh.uv[static_cast<std::size_t>(cloth.sheet.triangles[t][k])];
  } else {
    const Vec3 corner = mesh::bounding_box(cloth.start).min();
    for (const Vec3& x : cloth.start) cloth.mesh.uv.emplace_back((x - corner).head<2>());
  }
  for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
    if (!(mesh::rest_area(cloth.sheet, t) > 0))
      refuse(given.name, "triangles that have an area at rest, got number {} without", t);
  cloth.spacing = std::numbers::sqrt2 * mesh::min_height(cloth.sheet);
  cloth.material = material_of(given.material, given.name);
  cloth.velocity = vector_of(given.velocity, given.name, "velocity [m/s]");
  return cloth;
}

motion::Pose pose_of(const Pose& given, const std::string& object) {
  const auto& [w, x, y, z] = given.rotation;
  const motion::Pose pose{vector_of(given.position, object, "position [m]"), Quat(w, x, y, z)};
  if (!(std::abs(pose.rotation.norm() - 1) < 1e-6))
    refuse(object, "a unit quaternion w, x, y, z, got [{}]", fmt::join(given.rotation, ", "));
  return pose;
}

model::Body body_of(const Body& given, double fps, bool is_driven) {
  model::Body body;
  body.name = given.name;
  body.mesh = mesh_of(given.mesh, given.name);
  motion::PoseTrack track;
  for (const PoseKey& key : given.keys) {
    if (!std::isfinite(key.time) || (!track.keys.empty() && key.time <= track.keys.back().time))
      refuse(given.name, "keys at increasing times, got one at {:g} s", key.time);
    track.keys.push_back({key.time, pose_of(key.pose, given.name)});
  }
  const motion::Pose rest = pose_of(given.pose, given.name);
  if (is_driven && track.keys.size() < 2) {  // a body moves if it has two keys
    const motion::Pose stays = track.keys.empty() ? rest : track.keys.front().pose;
    track.keys = {{0, stays}, {1 / fps, stays}};
  }
  body.mover = std::make_shared<const model::Mover>(motion::Track(track, rest));
  body.moving = track.keys.size() > 1;
  body.collide = given.collide;
  check_range(given.friction, 0, 1e9, given.name, "a friction");
  body.friction = given.friction;
  check_range(given.mass, 0, 1e9, given.name, "a mass [kg]");
  if (given.mass == 0) return body;
  if (!track.keys.empty()) refuse(given.name, "a mass or keys, got both");
  try {
    body.dynamics = std::make_shared<const model::Dynamics>(
        model::Dynamics{mesh::RigidFrame(body.mesh.topology.triangles, body.mesh.positions), given.mass,
                        vector_of(given.velocity, given.name, "velocity [m/s]"), Vec3::Zero(),
                        -std::numeric_limits<double>::infinity()});
  } catch (const std::invalid_argument& expected) {
    refuse(given.name, "{} for a body with a mass", expected.what());
  }
  return body;
}

template <class Objects>
std::size_t number_of(const std::string& name, const Objects& objects, const char* kind) {
  const auto found = std::ranges::find(objects, name, [](const auto& object) { return object.name; });
  if (found == objects.end()) refuse("pin", "the name of a {}, got \"{}\"", kind, name);
  return static_cast<std::size_t>(found - objects.begin());
}

void add_pin(const Pin& given, model::Model& model) {
  model::Cloth& cloth = model.cloths[number_of(given.cloth, model.cloths, "cloth")];
  model::Pin& pin = cloth.pins.emplace_back();
  if (given.particles.empty()) refuse(cloth.name, "a pin with particles, got one without");
  Vec3 sum = Vec3::Zero();
  for (const int i : given.particles) {
    if (i < 0 || static_cast<std::size_t>(i) >= cloth.start.size())
      refuse(cloth.name, "pinned particles from 0 to {}, got {}", cloth.start.size() - 1, i);
    pin.particles.push_back({.particle = i});
    sum += cloth.start[static_cast<std::size_t>(i)];
  }
  pin.middle = sum / static_cast<double>(given.particles.size());
  if (!given.body.empty()) pin.body = number_of(given.body, model.bodies, "body");
  if (given.release < 0 || std::isnan(given.release))
    refuse(cloth.name, "a release of 0 s or later, got {:g}", given.release);
  if (std::isfinite(given.release)) pin.release = given.release;
}

}  // namespace

model::Model physics_of(const Model& given, const std::vector<std::string>& driven) {
  const std::string name = "model";
  model::Model model;
  model.source = name;
  check_range(given.fps, 1e-3, 1e6, name, "fps");
  check_range(given.step, 1e-7, 10, name, "a step [s]");
  check_range(given.newton_tolerance, 1e-8, 10, name, "a newton_tolerance");
  check_range(given.air_density, 0, 1e5, name, "an air_density [kg/m³]");
  model.time.fps = given.fps;
  model.time.step = given.step;
  static_assert(static_cast<int>(Method::bdf2) == static_cast<int>(integrator::Method::bdf2));
  model.time.integrator = static_cast<integrator::Method>(given.method);
  model.solver.newton_tolerance = given.newton_tolerance;
  model.physics.gravity = vector_of(given.gravity, name, "gravity [m/s²]");
  model.physics.wind = vector_of(given.wind, name, "wind [m/s]");
  model.physics.air_density = given.air_density;
  if (model.physics.gravity != Vec3::Zero()) model.up = -model.physics.gravity.normalized();
  model.contact.self = given.self_contact;
  std::set<std::string> names;
  const auto check_name = [&](const std::string& object) {
    if (object.empty() || !names.insert(object).second)
      refuse(name, "objects whose names differ from each other, got \"{}\" twice or empty", object);
  };
  model::Layer& layer = model.layers.emplace_back();
  for (const Cloth& cloth : given.cloths) {
    check_name(cloth.name);
    layer.cloths.push_back(model.cloths.size());
    model.cloths.push_back(cloth_of(cloth));
  }
  layer.dressed = layer.cloths;
  for (const Body& body : given.bodies) {
    check_name(body.name);
    model.bodies.push_back(body_of(body, given.fps, std::ranges::find(driven, body.name) != driven.end()));
  }
  for (const Pin& pin : given.pins) add_pin(pin, model);
  return model;
}

}  // namespace weft::library
