#include "film/environment/environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "core/log.hpp"
#include "film/environment/dynamics.hpp"
#include "film/environment/followers.hpp"
#include "film/environment/hanging.hpp"
#include "film/environment/orientation.hpp"
#include "film/scene/layers.hpp"
#include "physics/mesh/caps.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::environment {
namespace {

/// Makes the mesh of an obstacle in its own coordinates. The sizes of boxes are along the axes of the scene. Cones,
/// tori, cylinders, half pipes and planes are turned to the up axis. For files, axes_of() defines the axes.
struct MakeMesh {
  const scene::Scene& scene;
  const scene::Obstacle& obstacle;

  mesh::Mesh upright(mesh::Mesh mesh) const { return rotate_to_up_axis(std::move(mesh), scene.up); }

  mesh::Mesh operator()(const scene::Sphere& s) const { return mesh::make_sphere(s.radius, obstacle.segments); }
  mesh::Mesh operator()(const scene::BoxShape& s) const { return mesh::make_box(s.size, s.bevel, obstacle.segments); }
  mesh::Mesh operator()(const scene::Cone& s) const {
    return upright(mesh::make_cone(s.radius, s.height, obstacle.segments));
  }
  mesh::Mesh operator()(const scene::Torus& s) const {
    return upright(mesh::make_torus(s.radius, s.tube_radius, obstacle.segments));
  }
  mesh::Mesh operator()(const scene::Cylinder& s) const {
    return upright(mesh::make_cylinder(s.radius, s.height, obstacle.segments));
  }
  mesh::Mesh operator()(const scene::HalfPipe& s) const {
    return upright(mesh::make_half_pipe(s.radius, s.length, s.thickness, obstacle.segments));
  }
  mesh::Mesh operator()(const scene::Plane& s) const { return upright(mesh::make_plane(s.size)); }
  mesh::Mesh operator()(const scene::MeshFile& s) const { return load(s).mesh; }

  assets::LoadedMesh load(const scene::MeshFile& s) const {
    const std::string where =
        fmt::format("{}:{}:{}: obstacle.{}", scene.file.string(), obstacle.line, obstacle.column, obstacle.name);
    return assets::load_mesh(s.path, axes_of(scene, s.path, s.scale, s.up), where);
  }
};

model::Body make_obstacle(const scene::Scene& scene, const scene::Obstacle& obstacle) {
  model::Body body;
  body.name = obstacle.name;
  body.mesh = std::visit(MakeMesh{scene, obstacle}, obstacle.shape);
  body.mover = std::make_shared<const model::Mover>(motion::Track(obstacle.motion, obstacle.pose));
  body.may_move = obstacle.motion.keys.size() > 1;
  body.collide = obstacle.collide;
  body.friction = obstacle.friction;
  const auto* plane = std::get_if<scene::Plane>(&obstacle.shape);
  body.infinite_floor = plane != nullptr && plane->infinite;
  if (scene::is_dynamic(obstacle)) body.dynamics = make_dynamics(scene, obstacle, body.mesh);
  return body;
}

/// If some parts do not collide, fills details.passed_through (per triangle: 1 if it does not collide) and
/// body.colliding: all other triangles, and triangles that close the holes which these parts leave. A body without any
/// colliding triangle does not collide.
void list_colliding_triangles(model::Body& body, BodyDetails& details) {
  if (std::ranges::all_of(details.parts, &Part::collide)) return;
  std::vector<std::uint8_t> collides(body.mesh.positions.size(), 1);
  for (const Part& part : details.parts)
    for (std::size_t v = 0; v < collides.size(); ++v)
      if (part.vertices[v] != 0 && !part.only_followed) collides[v] = part.collide;
  for (const mesh::Triangle& t : body.mesh.topology.triangles) {
    const bool left_out = collides[t[0]] + collides[t[1]] + collides[t[2]] < 2;
    details.passed_through.push_back(left_out);
    if (!left_out) body.colliding.push_back(t);
  }
  mesh::close_cuts(body.mesh.topology.triangles, body.mesh.positions, body.colliding);
  if (body.colliding.empty()) body.collide = false;
}

/// Sets the advice in the error message about surfaces that touch at the start.
void set_start_advice(const scene::Scene& scene, model::Model& model) {
  const bool untangles = std::ranges::any_of(
      scene.cloths, [](const scene::Cloth& cloth) { return starts_untangled(cloth) || !cloth.over.empty(); });
  model.start_advice = untangles ? "'weft thumbnail --start' draws it as it was; move one of them"
                                 : "'weft thumbnail --start' draws it; move one of them, or leave it out of contact";
  if (!untangles) model.untangle_advice = "or give a cloth start = \"untangle\"";
}

/// Advice in the error message about a character that touches another surface at the start: most skirts touch arms that
/// hang down.
std::string advice_for(const scene::Character& character) {
  const auto* file = std::get_if<scene::CharacterFile>(&character.source);
  const bool arms_hang = file != nullptr && !file->stance_arms && character.dressing > 0;
  return arms_hang ? "where arms are in the way, stance_arms = 45 holds them off the body" : "";
}

model::Body make_character(const scene::Character& character, Actor actor, BodyDetails& details) {
  model::Body body;
  body.name = character.name;
  body.mesh = std::move(actor.mesh);
  body.may_move = actor.keys.is_moving();
  body.collide = character.collide;
  body.friction = character.friction;
  body.limbs = std::move(actor.limbs);
  body.advice = advice_for(character);
  for (const Part& part : actor.parts)
    if (part.is_patch()) body.patches.push_back({part.vertices, part.thickness, part.friction.value_or(body.friction)});
  details = {.look = character.look,
             .coloring = std::move(actor.coloring),
             .parts = std::move(actor.parts),
             .passed_through = {}};
  list_colliding_triangles(body, details);
  body.mover = std::make_shared<const model::Mover>(std::move(actor.keys));
  return body;
}

/// The index of the object with the name `name`; absent if there is none.
template <class Objects>
std::optional<std::size_t> number_of(const std::string& name, const Objects& objects) {
  const auto found = std::ranges::find(objects, name, [](const auto& object) { return object.name; });
  if (found == objects.end()) return std::nullopt;
  return static_cast<std::size_t>(found - objects.begin());
}

/// Mean start position of all particles in the region of a pin, also of those that another pin holds. Particles outside
/// the region that the pin holds through its `fade` do not count.
Vec3 middle_of(std::span<const model::WeightedParticle> particles, std::span<const Vec3> start) {
  Vec3 middle = Vec3::Zero();
  std::size_t count = 0;
  for (const model::WeightedParticle& chosen : particles) {
    if (chosen.faded) break;  // faded particles come last
    middle += start[static_cast<std::size_t>(chosen.particle)];
    ++count;
  }
  return middle / static_cast<double>(count);
}

/// Motion of the middle of the region of a pin, from its keys.
motion::PoseTrack motion_of(const scene::PinTrack& keyed, const Vec3& middle) {
  motion::PoseTrack track{keyed.interpolation, {}};
  for (const scene::PinKey& key : keyed.keys) {
    track.keys.push_back({key.time, key.pose});
    if (!key.in_world) track.keys.back().pose.position += middle;
  }
  return track;
}

}  // namespace

assets::LoadedMesh mesh_of(const scene::Scene& scene, const scene::Obstacle& obstacle) {
  const MakeMesh make{scene, obstacle};
  if (const auto* file = std::get_if<scene::MeshFile>(&obstacle.shape)) return make.load(*file);
  assets::LoadedMesh made;
  made.mesh = std::visit(make, obstacle.shape);
  return made;
}

Environment::Environment(const scene::Scene& scene) {
  model.source = scene.file.string();
  model.up = scene::up_vector(scene.up);
  model.time = {.fps = scene.time.fps,
                .preroll_frames = scene.preroll_frames(),
                .step = scene.time.step,
                .tolerance = scene.time.tolerance,
                .integrator = scene.time.integrator};
  model.physics = scene.physics;
  model.fans = scene.fans;
  model.solver = scene.solver;
  model.contact = scene.contact;
  model.layers = scene::list_layers(scene);
  set_start_advice(scene, model);
  const std::vector<Attached> attached = add_cloths(scene);
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    model.bodies.push_back(make_obstacle(scene, obstacle));
    bodies.push_back({.look = obstacle.look, .coloring = nullptr, .parts = {}, .passed_through = {}});
  }
  add_parents(scene);
  add_characters(scene);
  add_pin_motions(scene);
  add_attachments(scene, attached);
}

std::vector<Environment::Attached> Environment::add_cloths(const scene::Scene& scene) {
  std::vector<Attached> attached;
  Wearers wearers(scene);
  for (const scene::Cloth& cloth : scene.cloths) {
    MadeCloth made = make_cloth(scene, cloth, wearers);
    for (const std::string& warning : made.details.warnings) log::warn(warning);
    if (const std::string carrier = carrier_of(scene, cloth);
        !carrier.empty() && starts_untangled(cloth) && scene::rectangle_particles(cloth) > 0)
      if (const double moved = move_off_carrier(cloth, wearers.carrier(carrier, made.cloth.source), made.cloth.start))
        log::note(fmt::format("{}: starts {:.3g} m farther away from '{}', through which it would go",
                              made.cloth.source, moved, carrier));
    model.cloths.push_back(std::move(made.cloth));
    cloths.push_back(std::move(made.details));
    attached.push_back(std::move(made.attachments));
  }
  for (const model::Layer& layer : model.layers)
    for (const std::size_t c : layer.cloths) {
      model.cloths[c].put_on = (layer.first_frame + scene.preroll_frames()) / scene.time.fps;
      if (scene.cloths[c].over.empty()) continue;
      for (const scene::Cloth& inner : scene.cloths)
        if (scene::worn_over(scene, scene.cloths[c].name, inner.name)) model.cloths[c].over.push_back(inner.name);
    }
  return attached;
}

void Environment::add_characters(const scene::Scene& scene) {
  std::vector<ClothAtStart> at_start;
  for (const model::Cloth& cloth : model.cloths)
    at_start.push_back({cloth.start, cloth.mesh.topology.triangles, cloth.put_on});
  for (const scene::Character& character : scene.characters) {
    Followers followers = followers_of(scene, model.cloths, character.name);
    Actor actor = make_actor(scene, character, followers.points, at_start);
    for (const std::string& warning : actor.warnings) log::warn(warning);
    for (const std::string& note : actor.notes) log::note(note);
    const std::size_t vertices = actor.mesh.positions.size();
    for (PartFollower& follower : followers.rigid) follower.first += vertices;
    add_part_parents(scene, character, followers, actor.keys);
    // The key frames of a body with bones include the particles of pins.
    if (scene::skeleton_motion_of(character) != nullptr)
      for (const PinFollower& follower : followers.pins)
        model.cloths[follower.cloth].pins[follower.pin].first_vertex = vertices + follower.first;
    model.bodies.push_back(make_character(character, std::move(actor), bodies.emplace_back()));
  }
}

void Environment::add_pin_motions(const scene::Scene& scene) {
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    for (std::size_t p = 0; p < scene.cloths[c].pins.size(); ++p) {
      const scene::Pin& given = scene.cloths[c].pins[p];
      model::Pin& pin = model.cloths[c].pins[p];
      if (!given.follow.empty()) pin.body = number_of(scene::followed(given.follow).body, model.bodies);
      pin.middle = middle_of(pin.particles, model.cloths[c].start);
      pin.motion = motion_of(given.motion, pin.middle);
    }
}

void Environment::add_attachments(const scene::Scene& scene, const std::vector<Attached>& attached) {
  std::vector<std::size_t> seen(model.cloths.size(), 0);  // attachments so far, per cloth
  for (const scene::Attachment& given : scene.attachments) {
    const auto own = number_of(given.cloth, model.cloths);
    if (!own) continue;
    model.attachments.push_back({.name = given.name,
                                 .cloth = *own,
                                 .particles = attached[*own][seen[*own]++],
                                 .to_cloth = number_of(given.to, model.cloths),
                                 .to_body = number_of(given.to, model.bodies),
                                 .stiffness = given.stiffness,
                                 .length = given.length,
                                 .begin = given.begin,
                                 .release = given.release,
                                 .breaking_load = given.breaking_load});
  }
}

}  // namespace weft::environment
