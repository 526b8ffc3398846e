#include "api/physics_library/model_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "api/physics_library/data.hpp"
#include "api/physics_library/material_members.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::library {
namespace {

template <class... Arguments>
[[noreturn]] void refuse(const std::string& object, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw std::invalid_argument(object + ": expected " + fmt::format(text, std::forward<Arguments>(arguments)...));
}

// Bounds of absolute values, as in scenes (src/film/scene/*_rules.cpp).
constexpr double kFarthest = 1e5;  // [m]
constexpr double kFastest = 1e4;   // [m/s]

// Whether the absolute values of all components are at most `largest`; false for NaN.
bool is_within(const Vec3& x, double largest) {
  return (x.array().abs() <= largest).all();
}

Vec3 vector_of(const Vector& x, double largest, const std::string& object, const char* what) {
  Vec3 vector(x.data());
  if (!is_within(vector, largest))
    refuse(object, "{} from {:g} to {:g}, got [{}]", what, -largest, largest, fmt::join(x, ", "));
  return vector;
}

void check_range(double value, double low, double high, const std::string& object, const char* what) {
  if (!(value >= low && value <= high)) refuse(object, "{} from {:g} to {:g}, got {:g}", what, low, high, value);
}

// How many triangles may share an edge: one or two in a cloth; any number in a body, because meshes of other programs
// often have edges with more than two triangles.
enum class Edges { any, of_a_sheet };

mesh::Mesh mesh_of(const Mesh& given, Edges edges, const std::string& object) {
  mesh::Mesh mesh;
  for (const Vector& given_x : given.positions) {
    const Vec3& x = mesh.positions.emplace_back(given_x.data());
    if (!is_within(x, kFarthest))
      refuse(object, "positions [m] from {:g} to {:g}, got [{}] as vertex {}", -kFarthest, kFarthest,
             fmt::join(given_x, ", "), mesh.positions.size() - 1);
  }
  for (const Triangle& t : given.triangles) mesh.topology.triangles.push_back({t[0], t[1], t[2]});
  if (mesh.topology.triangles.empty()) refuse(object, "at least one triangle, got none");
  const mesh::TopologyReport report = mesh::inspect(mesh.topology.triangles, mesh.positions.size());
  const auto corners = [&](Index triangle) { return fmt::join(given.triangles[at(triangle)], ", "); };
  if (!report.out_of_range.empty())
    refuse(object, "triangles of vertices from 0 to {}, got [{}] as triangle {}", mesh.positions.size() - 1,
           corners(report.out_of_range[0]), report.out_of_range[0]);
  if (!report.degenerate.empty())
    refuse(object, "triangles of three different vertices, got [{}] as triangle {}", corners(report.degenerate[0]),
           report.degenerate[0]);
  if (edges == Edges::any) return mesh;
  if (!report.non_manifold.empty())
    refuse(object, "edges of one or two triangles, got {} edges of more, the first of vertices {}",
           report.non_manifold.size(), fmt::join(report.non_manifold[0], " and "));
  if (!report.misoriented.empty())
    refuse(object, "triangles that face the same way, got {} edges between two that do not, the first of vertices {}",
           report.misoriented.size(), fmt::join(report.misoriented[0], " and "));
  return mesh;
}

model::Material material_of(const Material& given, const std::string& object) {
  model::Material material;
  for (const MaterialMember& member : kMaterialMembers) {
    check_range(given.*member.given, member.low, member.high, object, member.what);
    material.*member.physics = given.*member.given;
  }
  return material;
}

// Refuses vertices that no triangle uses, because they would be particles without mass.
void check_vertices_are_used(const mesh::Mesh& mesh, const std::string& object) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const mesh::Triangle& t : mesh.topology.triangles)
    for (const Index v : t) used[static_cast<std::size_t>(v)] = 1;
  const auto loose = std::ranges::find(used, 0);
  if (loose != used.end()) refuse(object, "vertices that triangles use, got number {} alone", loose - used.begin());
}

// Refuses vertices at the same place, because their triangles would touch at the start. In meshes
// of other programs, seams of the texture often have two vertices at the same place.
void check_vertices_are_apart(const mesh::Mesh& mesh, const std::string& object) {
  std::map<std::array<double, 3>, std::size_t> places;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& x = mesh.positions[v];
    const auto [first, is_new] = places.try_emplace({x.x(), x.y(), x.z()}, v);
    if (!is_new)
      refuse(object, "vertices in different places, got {} and {} in the same one; merge them", first->second, v);
  }
}

// Sets the rest shape of a cloth to the flat fabric.
void use_rest(const std::vector<RestPoint>& rest, model::Cloth& cloth) {
  if (rest.size() != cloth.start.size())
    refuse(cloth.name, "as many rest points as particles ({}), got {}", cloth.start.size(), rest.size());
  for (const RestPoint& point : rest) {
    for (const double c : point) check_range(c, -kFarthest, kFarthest, cloth.name, "a rest coordinate [m]");
    cloth.mesh.uv.emplace_back(point[0], point[1]);
  }
  cloth.sheet.sewn = true;
  for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      cloth.sheet.material[t][k] = cloth.mesh.uv[static_cast<std::size_t>(cloth.sheet.triangles[t][k])];
}

void check_triangles(const model::Cloth& cloth) {
  for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
    if (!(mesh::rest_area(cloth.sheet, t) > 0))
      refuse(cloth.name,
             "triangles that have an area at rest and go counter-clockwise in the flat fabric, got number {} otherwise",
             t);
  if (const mesh::FlatTriangles flat = mesh::find_flat_triangles(cloth.sheet); flat.count > 0)
    refuse(cloth.name,
           "triangles at least a {:g}th as high as the longest edge ({:.4g} m), got number {} with {:.3g} m",
           mesh::kMaxEdgeToHeightRatio, flat.longest_edge, flat.flattest, flat.least_height);
}

model::Cloth cloth_of(const Cloth& given, bool self_contact) {
  model::Cloth cloth;
  cloth.name = cloth.source = given.name;
  cloth.mesh = mesh_of(given.mesh, Edges::of_a_sheet, given.name);
  check_vertices_are_used(cloth.mesh, given.name);
  if (self_contact) check_vertices_are_apart(cloth.mesh, given.name);
  cloth.sheet = mesh::make_sheet_from_mesh(cloth.mesh);
  cloth.start = cloth.mesh.positions;
  if (!given.rest.empty()) {
    use_rest(given.rest, cloth);
  } else {
    const Vec3 corner = mesh::bounding_box(cloth.start).min();
    for (const Vec3& x : cloth.start) cloth.mesh.uv.emplace_back((x - corner).head<2>());
  }
  check_triangles(cloth);
  cloth.spacing = std::numbers::sqrt2 * mesh::min_height(cloth.sheet);
  cloth.material = material_of(given.material, given.name);
  cloth.velocity = vector_of(given.velocity, kFastest, given.name, "a velocity [m/s]");
  return cloth;
}

motion::PoseTrack track_of(const std::vector<PoseKey>& keys, const std::string& object) {
  motion::PoseTrack track;
  for (const PoseKey& key : keys) {
    check_range(key.time, -kFarthest, kFarthest, object, "a key's time [s]");
    if (!track.keys.empty() && key.time < track.keys.back().time + model::kMinStep)
      refuse(object, "keys at increasing times, {:g} s apart or more, got one at {:g} s", model::kMinStep, key.time);
    track.keys.push_back({key.time, pose_of(key.pose, object)});
  }
  return track;
}

model::Body body_of(const Body& given, bool is_driven) {
  model::Body body;
  body.name = given.name;
  body.mesh = mesh_of(given.mesh, Edges::any, given.name);
  body.mover = std::make_shared<const model::Mover>(
      motion::Track(track_of(given.keys, given.name), pose_of(given.pose, given.name)));
  body.may_move = is_driven || given.keys.size() > 1;
  body.collide = given.collide;
  check_range(given.friction, 0, 10, given.name, "a friction");
  body.friction = given.friction;
  check_range(given.mass, 0, 1e6, given.name, "a mass [kg]");
  const Vec3 velocity = vector_of(given.velocity, kFastest, given.name, "a velocity [m/s]");
  if (given.mass == 0) {
    if (velocity != Vec3::Zero()) refuse(given.name, "a velocity of a body with a mass, got one without");
    return body;
  }
  if (!given.keys.empty() || is_driven) refuse(given.name, "a mass, or keys or a name in `driven`, got both");
  try {
    body.dynamics = std::make_shared<const model::Dynamics>(
        model::Dynamics{mesh::RigidFrame(body.mesh.topology.triangles, body.mesh.positions), given.mass, velocity,
                        Vec3::Zero(), -std::numeric_limits<double>::infinity()});
  } catch (const std::invalid_argument& expected) {
    refuse(given.name, "{} for a body with a mass", expected.what());
  }
  return body;
}

template <class Objects>
std::size_t number_of(const std::string& name, const Objects& objects, const char* kind) {
  const auto found = std::ranges::find(objects, name, [](const auto& object) { return object.name; });
  if (found != objects.end()) return static_cast<std::size_t>(found - objects.begin());
  refuse("pin", "a {} ({}), got \"{}\"", kind, fmt::join(names_of(objects), ", "), name);
}

// Adds a pin to its cloth, and its particles to `held`, which has the cloth and the index of each
// pinned particle.
void add_pin(const Pin& given, std::set<std::pair<std::string, int>>& held, model::Model& model) {
  model::Cloth& cloth = model.cloths[number_of(given.cloth, model.cloths, "cloth")];
  model::Pin& pin = cloth.pins.emplace_back();
  if (given.particles.empty()) refuse(cloth.name, "a pin with particles, got one without");
  Vec3 sum = Vec3::Zero();
  for (const int i : given.particles) {
    if (i < 0 || static_cast<std::size_t>(i) >= cloth.start.size())
      refuse(cloth.name, "pinned particles from 0 to {}, got {}", cloth.start.size() - 1, i);
    if (!held.insert({given.cloth, i}).second)
      refuse(cloth.name, "each particle once, in one pin alone, got {} twice", i);
    pin.particles.push_back({.particle = i});
    sum += cloth.start[static_cast<std::size_t>(i)];
  }
  pin.middle = sum / static_cast<double>(given.particles.size());
  if (!given.body.empty()) {
    pin.body = number_of(given.body, model.bodies, "body");
    if (model.bodies[*pin.body].dynamics)
      refuse(cloth.name, "a pin at a body that forces do not move, got {}", given.body);
  }
  if (!(given.release >= 0)) refuse(cloth.name, "a release of 0 s or later, got {:g}", given.release);
  if (std::isfinite(given.release)) pin.release = given.release;
}

}  // namespace

motion::Pose pose_of(const Pose& given, const std::string& object) {
  const auto& [w, x, y, z] = given.rotation;
  motion::Pose pose{vector_of(given.position, kFarthest, object, "a position [m]"), Quat(w, x, y, z)};
  if (!(std::abs(pose.rotation.norm() - 1) < 1e-6))
    refuse(object, "a unit quaternion w, x, y, z, got [{}]", fmt::join(given.rotation, ", "));
  return pose;
}

Vec3 gravity_of(const Vector& given, const std::string& object) {
  return vector_of(given, kFarthest, object, "gravity [m/s²]");
}
Vec3 wind_of(const Vector& given, const std::string& object) {
  return vector_of(given, 1000, object, "wind [m/s]");
}

model::Model physics_of(const Model& given, const std::vector<std::string>& driven) {
  const std::string name = "model";
  model::Model model;
  model.source = name;
  check_range(given.fps, kAboveZero, 1000, name, "fps");
  check_range(given.step, model::kMinStep, 1, name, "a step [s]");
  if (given.fps * given.step * model::kMaxStepsInFrame < 1)
    refuse(name, "at most {:g} steps in a frame, got fps = {:g} and step = {:g} s", model::kMaxStepsInFrame, given.fps,
           given.step);
  check_range(given.newton_tolerance, kAboveZero, 1, name, "a newton_tolerance");
  check_range(given.air_density, 0, 1000, name, "an air_density [kg/m³]");
  if (given.method < Method::implicit_euler || given.method > Method::bdf2)
    refuse(name, "one of the methods, got number {}", static_cast<int>(given.method));
  model.time.fps = given.fps;
  model.time.step = given.step;
  static_assert(static_cast<int>(Method::implicit_euler) == static_cast<int>(integrator::Method::implicit_euler) &&
                static_cast<int>(Method::implicit_midpoint) ==
                    static_cast<int>(integrator::Method::implicit_midpoint) &&
                static_cast<int>(Method::bdf2) == static_cast<int>(integrator::Method::bdf2));
  model.time.integrator = static_cast<integrator::Method>(given.method);
  model.solver.newton_tolerance = given.newton_tolerance;
  model.physics.gravity = gravity_of(given.gravity, name);
  model.physics.wind = wind_of(given.wind, name);
  model.physics.air_density = given.air_density;
  if (model.physics.gravity != Vec3::Zero()) model.up = -model.physics.gravity.normalized();
  model.contact.self = given.self_contact;
  std::set<std::string> names;
  const auto check_name = [&](const std::string& object) {
    if (object.empty()) refuse(name, "objects with names, got one without");
    if (!names.insert(object).second) refuse(name, "objects whose names differ, got {} twice", object);
  };
  for (const Cloth& cloth : given.cloths) {
    check_name(cloth.name);
    model.cloths.push_back(cloth_of(cloth, given.self_contact));
  }
  for (const Body& body : given.bodies) {
    check_name(body.name);
    model.bodies.push_back(body_of(body, std::ranges::find(driven, body.name) != driven.end()));
  }
  std::set<std::pair<std::string, int>> held;
  for (const Pin& pin : given.pins) add_pin(pin, held, model);
  return model;
}

}  // namespace weft::library
