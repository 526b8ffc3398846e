#include "physics/simulation/collision_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "core/parallel_append.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/simulation/intersections.hpp"

namespace weft::simulation {
namespace {

bool bodies_collide(const model::Model& model) {
  return model.contact.obstacles && std::ranges::any_of(model.bodies, &model::Body::collide);
}

bool moves_by_forces(const model::Body& body) {
  return body.dynamics != nullptr;
}

// Numbers of the colliding bodies; dynamic bodies (moved by forces) come first. The engine counts the frame particles
// of all dynamic bodies as vertices of the first one. Therefore, if there are dynamic bodies but none collides, the
// first of them is listed, too.
std::vector<std::size_t> colliding_bodies(const model::Model& model) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.contact.obstacles && model.bodies[b].collide) bodies.push_back(b);
  std::stable_partition(bodies.begin(), bodies.end(), [&](std::size_t b) { return moves_by_forces(model.bodies[b]); });
  const auto first = std::ranges::find_if(model.bodies, moves_by_forces);
  if (first != model.bodies.end() && (bodies.empty() || !moves_by_forces(model.bodies[bodies.front()])))
    bodies.insert(bodies.begin(), static_cast<std::size_t>(first - model.bodies.begin()));
  return bodies;
}

// Contact thickness of a dynamic body [m].
double thickness_of(const model::Dynamics& dynamics) {
  return std::min(numerics.bodies.thickness,
                  numerics.bodies.thickness_of_size * dynamics.frame.deviations().minCoeff());
}

// Friction of pairs that the model names. The engine numbers the cloths first, then the colliding bodies.
std::vector<collision::PairFriction> friction_pairs(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::Cloth& cloth : model.cloths) names.push_back(cloth.name);
  for (std::size_t b : colliding_bodies(model)) names.push_back(model.bodies[b].name);
  std::vector<collision::PairFriction> pairs;
  for (const model::FrictionPair& pair : model.contact.pairs) {
    const auto a = std::find(names.begin(), names.end(), pair.first),
               b = std::find(names.begin(), names.end(), pair.second);
    if (a == names.end() || b == names.end()) continue;  // the body does not collide
    pairs.push_back({static_cast<std::size_t>(a - names.begin()),
                     static_cast<std::size_t>(b - names.begin()),
                     {pair.friction, pair.static_friction.value_or(pair.friction)}});
  }
  return pairs;
}

collision::BroadPhaseOptions search_options(const model::Search& search) {
  constexpr std::array<int, 3> kDirections{6, 18, 26};
  constexpr std::array<int, 3> kChildren{2, 4, 8};
  collision::BroadPhaseOptions options;
  options.directions = kDirections[static_cast<std::size_t>(search.bounds)];
  options.children = kChildren[static_cast<std::size_t>(search.tree)];
  options.leaf = search.leaf;
  options.open_longer_side = search.open_longer_side;
  options.separation_list = search.separation_lists;
  options.velocity_cones = search.velocity_cones;
  options.normal_cones = search.normal_cones;
  return options;
}

collision::EngineParameters engine_parameters(const model::Model& model) {
  const model::Contact& contact = model.contact;
  const bool velocity = contact.response == model::Response::velocity_constraints;
  double spacing = std::numeric_limits<double>::infinity();
  for (const model::Cloth& cloth : model.cloths) spacing = std::min(spacing, cloth.spacing);
  return {.search = {contact.self, contact.obstacles, contact.search.reuse, contact.search.coherence,
                     search_options(contact.search)},
          .contact = {contact.stiffness, model.time.step, friction_pairs(model)},
          .response = velocity ? collision::ResponseForm::velocity_constraints : collision::ResponseForm::springs,
          .stick_speed = std::max(numerics.contact.stick_velocity,
                                  std::isinf(spacing) ? 0 : numerics.contact.stick_spacings * spacing)};
}

collision::Bodies make_bodies(const model::Model& model, const ClothSystem& cloth) {
  collision::Bodies bodies;
  for (std::size_t c = 0; c < model.cloths.size(); ++c) {
    const model::Material& material = model.cloths[c].material;
    const double of_spacing = model.cloths[c].rope ? 1 / model::kMinRopePiece : numerics.contact.thickness_of_spacing;
    const double thickness = std::min(material.thickness, of_spacing * model.cloths[c].spacing);
    const mesh::Mesh& mesh = model.cloths[c].mesh;
    bodies.add(mesh.topology.triangles, static_cast<Index>(mesh.positions.size()),
               {.deformable = true, .thickness = thickness, .friction = material.friction});
  }
  const Index cloth_particles = cloth.first_particle(cloth.cloths());
  Index frames = cloth.first_particle(cloth.parts()) - cloth_particles;
  const std::vector<Index> first_of_frames = cloth.first_of_frames(model);
  for (std::size_t b : colliding_bodies(model)) {
    const model::Body& body = model.bodies[b];
    if (body.dynamics) {
      const bool collides = model.contact.obstacles && body.collide;
      bodies.add(collides ? body.colliding_triangles() : std::span<const mesh::Triangle>(),
                 static_cast<Index>(body.mesh.positions.size()),
                 {.deformable = true,
                  .thickness = collides ? thickness_of(*body.dynamics) : 0,
                  .friction = body.friction,
                  .rigid = true,
                  .frame = first_of_frames[b]},
                 {}, {}, std::exchange(frames, 0));
      continue;
    }
    std::vector<collision::Patch> patches;
    for (const model::Patch& patch : body.patches) patches.push_back({patch.vertices, patch.thickness, patch.friction});
    bodies.add(body.colliding_triangles(), static_cast<Index>(body.mesh.positions.size()),
               {.friction = body.friction, .may_move = body.may_move, .rigid = !body.deforms()}, patches, body.limbs);
  }
  return bodies;
}

// Largest distance of a vertex from the origin of a body that moves without deforming [m]; 0 for other bodies.
double radius_of(const model::Body& body) {
  double radius_sq = 0;
  if (body.may_move && !body.deforms())
    for (const Vec3& x : body.mesh.positions) radius_sq = std::max(radius_sq, x.squaredNorm());
  return std::sqrt(radius_sq);
}

// Upper bound of the distance of an arc of this angle [rad] from its chord [m].
double sagitta(double radius, double angle) {
  return radius * angle * angle / 8;
}

// Angle by which a body turns from t to t + h at its largest angular velocity [rad]. Samples at the start, middle and
// end of the step are enough: the angular velocity changes little in a step, except that a body stops at its last key.
template <class PoseAt>
double max_turn(double t, double h, const PoseAt& pose_at) {
  double angle = 0;
  for (const double fraction : {0.0, 0.5, 1.0})
    angle = std::max(angle, h * pose_at(t + fraction * h).angular_velocity.norm());
  return angle;
}

}  // namespace

bool CollisionStage::is_needed(const model::Model& model) {
  const auto meets = [](const model::Body& body) { return moves_by_forces(body) && body.collide; };
  return (!model.cloths.empty() && (model.contact.self || bodies_collide(model))) ||
         (model.contact.obstacles && std::ranges::any_of(model.bodies, meets));
}

CollisionStage::CollisionStage(const model::Model& model, const ClothSystem& cloth, SystemState& start)
    : model_(model),
      bodies_(colliding_bodies(model)),
      particles_(cloth.masses().size()),
      rigid_(make_rigid_vertices(cloth)),
      masses_(masses_of_all(cloth)),
      engine_(make_bodies(model, cloth), engine_parameters(model), append_bodies(start), masses_) {
  for (const auto& object : model.cloths) names_.push_back(object.name);
  for (std::size_t b : bodies_) names_.push_back(model.bodies[b].name);
  motions_.resize(names_.size());
  for (std::size_t b : bodies_) {
    radii_.push_back(radius_of(model.bodies[b]));
    boxes_.push_back(mesh::bounding_box(model.bodies[b].mesh.positions));
  }
}

RigidVertices CollisionStage::make_rigid_vertices(const ClothSystem& cloth) const {
  RigidVertices vertices(static_cast<Index>(cloth.masses().size()));
  const std::vector<Index> first_of_frames = cloth.first_of_frames(model_);
  for (const std::size_t b : bodies_)
    if (model_.bodies[b].dynamics) vertices.add(model_.bodies[b].dynamics->frame, first_of_frames[b]);
  return vertices;
}

std::vector<double> CollisionStage::masses_of_all(const ClothSystem& cloth) const {
  std::vector<double> masses(cloth.masses().begin(), cloth.masses().end());
  for (Index v = rigid_.first(); v < rigid_.end(); ++v) masses.push_back(rigid_.mass_of(v, cloth.masses()));
  return masses;
}

const std::vector<Vec3>& CollisionStage::append_bodies(SystemState& start) const {
  start.x.resize(static_cast<std::size_t>(rigid_.end()));
  rigid_.place(start.x);
  for (std::size_t b : bodies_) {
    if (model_.bodies[b].dynamics) continue;
    const std::size_t first = start.x.size();
    start.x.resize(first + model_.bodies[b].mesh.positions.size());
    model_.place(b, start.bodies_time, std::span(start.x).subspan(first));
  }
  return start.x;
}

std::vector<IntersectionPlace> CollisionStage::find_intersections(const SystemState& start) {
  return group_intersections(engine_.find_intersections(start.x), engine_.bodies(), names_, start.x);
}

// Bodies that do not move stay where append_bodies() has put them.
void CollisionStage::place_bodies(double t, SystemState& state) const {
  rigid_.place(state.x);
  if (state.bodies_time == t) return;
  state.bodies_time = t;
  auto first = static_cast<std::size_t>(rigid_.end());
  for (std::size_t b : bodies_) {
    if (model_.bodies[b].dynamics) continue;
    const std::size_t count = model_.bodies[b].mesh.positions.size();
    if (model_.bodies[b].may_move) model_.place(b, t, std::span(state.x).subspan(first, count));
    first += count;
  }
}

// Text that names the objects and triangles of a pair, and its place.
std::string CollisionStage::describe(const collision::CornerPair& pair, const SystemState& state) const {
  const Vec3& at = state.x[pair.a[0]];
  const collision::Bodies& bodies = engine_.bodies();
  return fmt::format("'{}' (triangle {}) and '{}' (triangle {}) touching near ({:.4g}, {:.4g}, {:.4g}) m",
                     names_[bodies.body_of(pair.a[0])], bodies.triangle_of(pair.a), names_[bodies.body_of(pair.b[0])],
                     bodies.triangle_of(pair.b), at.x(), at.y(), at.z());
}

bool CollisionStage::begin_step(double t, double h, std::span<const integrator::HeldParticle> held, SystemState& now,
                                SystemState& next, bool is_repeated) {
  place_bodies(t, now);
  movable_.assign(now.x.size(), collision::kFixed);
  obstructed_pins_.clear();
  x_restart_.clear();
  std::fill_n(movable_.begin(), rigid_.end(), std::uint8_t{collision::kFree});
  for (std::size_t i = 0; i < particles_; ++i) next.x[i] = now.x[i] + h * now.v[i];
  for (const integrator::HeldParticle& particle : held) {
    next.x[particle.constraint.particle] = particle.x_end;
    movable_[particle.constraint.particle] = collision::kPinned;
  }
  place_bodies(t + h, next);
  for (std::size_t b = 0; b < bodies_.size() && is_dynamic(b); ++b) {
    const collision::BodyTraits& traits = engine_.bodies()[model_.cloths.size() + b];
    if (movable_[static_cast<std::size_t>(traits.frame)] != collision::kPinned) continue;
    // The body is not released yet: keys move it, as they move other obstacles.
    std::fill_n(movable_.begin() + traits.frame, mesh::RigidFrame::kParticles, std::uint8_t{collision::kFixed});
    std::ranges::fill(engine_.bodies()
                          .part(model_.cloths.size() + b, std::span(movable_))
                          .last(model_.bodies[bodies_[b]].mesh.positions.size()),
                      std::uint8_t{collision::kFixed});
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) motions_[model_.cloths.size() + b] = motion_of(bodies_[b], t, h);
  return engine_.begin_step(now.x, next.x, movable_, h, motions_, is_repeated);
}

// Whether forces move a colliding body in the whole step that ends at t_end [s]; see any_frame_is_released().
bool CollisionStage::is_moved_by_forces(std::size_t body, double t_end) const {
  return is_dynamic(body) && model::is_later(t_end, model_.bodies[bodies_[body]].dynamics->release);
}

bool CollisionStage::obstacle_turns_too_far(double t, double h, const SystemState& now) const {
  const double max_sagitta = numerics.contact.verlet_margin * engine_.detection_distance();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (radii_[b] == 0 || is_moved_by_forces(b, t + h)) continue;
    const double angle = max_turn(t, h, [&](double instant) { return model_.pose(bodies_[b], instant); });
    const double of_origin = origin_sagitta(b, t, h);
    if (sagitta(radii_[b], angle) + of_origin > max_sagitta &&
        solved_surface_comes_near(b, t, h, angle, of_origin, now))
      return true;
  }
  return false;
}

// Upper bound of the distance of the path of a body's origin from its chord, from t to t + h, as far as the bodies that
// it follows turn [m].
double CollisionStage::origin_sagitta(std::size_t body, double t, double h) const {
  double sum = 0;
  Vec3 origin = model_.pose(bodies_[body], t).position;
  const model::Parent* parent = &model_.bodies[bodies_[body]].parent;
  while (parent->is_any()) {
    const auto pose_at = [&](double instant) { return model_.pose(*parent, instant); };
    const Vec3 centre = pose_at(t).position;
    sum += sagitta((origin - centre).norm(), max_turn(t, h, pose_at));
    if (parent->part) break;  // a part of a character follows nothing
    origin = centre;
    parent = &model_.bodies[parent->body].parent;
  }
  return sum;
}

bool CollisionStage::bodies_are_constant(double t0, double t1, SystemState& now, SystemState& next) const {
  place_bodies(t0, now);
  place_bodies(t1, next);
  const Box3 solved = mesh::bounding_box(std::span(now.x).first(static_cast<std::size_t>(rigid_.end())));
  const collision::Bodies& bodies = engine_.bodies();
  for (std::size_t b = model_.cloths.size(); b < bodies.size(); ++b) {
    if (bodies[b].deformable) continue;
    const auto from = bodies.part(b, std::span<const Vec3>(now.x)), to = bodies.part(b, std::span<const Vec3>(next.x));
    if (std::ranges::equal(from, to)) continue;
    Box3 swept = mesh::bounding_box(from).merged(mesh::bounding_box(to));
    swept.min().array() -= engine_.detection_distance();
    swept.max().array() += engine_.detection_distance();
    if (swept.intersects(solved)) return false;
  }
  return true;
}

bool CollisionStage::obstacles_move_little(const SystemState& now, const SystemState& next) const {
  const double max_motion = numerics.contact.verlet_margin * engine_.detection_distance();
  for (auto v = static_cast<std::size_t>(rigid_.end()); v < now.x.size(); ++v)
    if ((next.x[v] - now.x[v]).squaredNorm() > max_motion * max_motion &&
        !engine_.is_clear(engine_.bodies().body_of(static_cast<Index>(v))))
      return false;
  return true;
}

// Whether the obstacle `body`, which turns by `angle` [rad] from t to t + h, may come near cloth or
// a body that forces move: whether the box that it sweeps, enlarged by the detection distance,
// overlaps the box that a triangle of them sweeps at unchanged velocity. `of_origin`: its origin_sagitta() [m].
bool CollisionStage::solved_surface_comes_near(std::size_t body, double t, double h, double angle, double of_origin,
                                               const SystemState& now) const {
  constexpr double kMaxPieceAngle = 0.25;  // [rad]
  const int pieces = 1 + static_cast<int>(std::min(angle, 100.0) / kMaxPieceAngle);
  Box3 box;
  for (int p = 0; p <= pieces; ++p) {
    const motion::PoseSample pose = model_.pose(bodies_[body], t + h * p / pieces);
    for (int corner = 0; corner < 8; ++corner)
      box.extend(Vec3(pose.position + pose.rotation * boxes_[body].corner(static_cast<Box3::CornerType>(corner))));
  }
  const double margin = engine_.detection_distance() +
                        std::min(1.0, sagitta(1, angle / pieces)) * boxes_[body].diagonal().norm() + of_origin;
  box.min().array() -= margin;
  box.max().array() += margin;
  std::vector<Vec3> end(now.x.begin(), now.x.begin() + rigid_.end());
  for (std::size_t i = 0; i < particles_; ++i) end[i] += h * now.v[i];
  rigid_.place(end);
  const auto meets = [&](const collision::Triangle& triangle) {
    Box3 swept;
    for (Index v : triangle) swept.extend(now.x[v]), swept.extend(end[v]);
    return swept.intersects(box);
  };
  const std::span<const collision::Surface> surfaces = engine_.bodies().surfaces();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (s >= model_.cloths.size() && !is_moved_by_forces(s - model_.cloths.size(), t + h)) continue;
    if (std::ranges::any_of(surfaces[s].triangles, meets)) return true;
  }
  return false;
}

// Rigid motion of a body from t to t + h; the identity for bodies that do not move, that deform, or that forces move.
collision::RigidMotion CollisionStage::motion_of(std::size_t body, double t, double h) const {
  collision::RigidMotion motion;
  const model::Body& object = model_.bodies[body];
  if (!object.may_move || object.deforms() || object.dynamics) return motion;
  const motion::PoseSample from = model_.pose(body, t), to = model_.pose(body, t + h);
  if (from.rotation.coeffs() != to.rotation.coeffs())
    motion.rotation = (to.rotation * from.rotation.conjugate()).toRotationMatrix();
  motion.translation = to.position - motion.rotation * from.position;
  return motion;
}

void CollisionStage::append_prescribed_particles(std::vector<integrator::HeldParticle>& held) const {
  for (const collision::PrescribedParticle& particle : response().prescribed())
    if (movable_[particle.constraint.particle] == collision::kFree)
      held.push_back({particle.constraint, particle.x_end, particle.v_end});
}

std::optional<std::string> CollisionStage::push_apart(double h, bool may_pinch, bool may_move_pins,
                                                      const SystemState& now, SystemState& next) {
  solved_.assign(next.particles().begin(), next.particles().end());
  const collision::SeparationReport report =
      engine_.push_apart(trajectory_start(now), next.x, movable_, may_pinch, may_move_pins);
  obstructed_pins_ = report.obstructed_pins;
  if (!report.separated) {
    std::ranges::copy(solved_, next.x.begin());
    return "cannot keep " + describe(report.unseparated_pair, now) + " apart";
  }
  for (std::size_t i = 0; i < particles_; ++i) next.v[i] += (next.x[i] - solved_[i]) / h;
  note_pinches(now);
  return std::nullopt;
}

bool CollisionStage::find_pins_between_cloths() {
  const auto is_cloth = [&](Index v) { return engine_.bodies().body_of(v) < model_.cloths.size(); };
  for (const collision::CornerPair& pair : engine_.failing()) {
    if (!is_cloth(pair.a[0]) || !is_cloth(pair.b[0])) continue;
    for (const collision::Triangle& corners : {pair.a, pair.b})
      for (Index v : corners)
        if (movable_[static_cast<std::size_t>(v)] == collision::kPinned) obstructed_pins_.push_back({v, pair});
  }
  return !obstructed_pins_.empty();
}

void CollisionStage::continue_from(const SystemState& next) {
  x_restart_ = next.x;
  engine_.continue_from(x_restart_);
}

bool CollisionStage::restarts_at(const SystemState& next) const {
  const double most =
      std::min(numerics.separation.restored_gap, numerics.contact.verlet_margin * engine_.detection_distance());
  return !x_restart_.empty() && parallel_all_of(particles_, [&](std::size_t i) {
    return (next.x[i] - x_restart_[i]).squaredNorm() <= most * most;
  });
}

std::string CollisionStage::describe(const collision::ObstructedPin& pin, const SystemState& now) const {
  const auto is_it = [&](Index v) { return v == pin.particle; };
  const collision::Triangle& other = std::ranges::any_of(pin.pair.a, is_it) ? pin.pair.b : pin.pair.a;
  const Vec3& at = now.x[pin.particle];
  const std::size_t body = engine_.bodies().body_of(other[0]);
  return fmt::format("'{}'{} near ({:.4g}, {:.4g}, {:.4g}) m", names_[body],
                     body == engine_.bodies().body_of(pin.particle) ? " itself" : "", at.x(), at.y(), at.z());
}

std::string CollisionStage::describe(const collision::Pinch& pinch) const {
  const std::string& obstacle = names_[pinch.obstacle];
  const std::string between = !pinch.pressing_obstacle ? fmt::format("in front of '{}'", obstacle)
                              : *pinch.pressing_obstacle == pinch.obstacle
                                  ? fmt::format("between parts of '{}'", obstacle)
                                  : fmt::format("between '{}' and '{}'", obstacle, names_[*pinch.pressing_obstacle]);
  return fmt::format("'{}' has no room {} near ({:.4g}, {:.4g}, {:.4g}) m", names_[pinch.cloth], between,
                     pinch.place.x(), pinch.place.y(), pinch.place.z());
}

void CollisionStage::note_pinches(const SystemState& start) {
  if (engine_.pinched_pairs() == 0) return;
  pinches_.pairs = std::max(pinches_.pairs, engine_.pinched_pairs());
  for (const collision::Pinch& pinch : engine_.pinches(start.x)) {
    const PinchingObjects objects{pinch.cloth, pinch.obstacle};
    if (pinching_.insert(objects).second && !pinching_before_.contains(objects))
      pinches_.begun.push_back(describe(pinch));
  }
}

void CollisionStage::copy_state_from(const CollisionStage& before, std::span<const std::size_t> cloths) {
  const collision::Bodies &old_bodies = before.engine_.bodies(), &bodies = engine_.bodies();
  const auto here = [&](std::size_t body) {
    return body < cloths.size() ? cloths[body] : body - cloths.size() + model_.cloths.size();
  };
  for (const auto& [key, origin] : before.engine_.exempted().origins()) {
    const std::size_t cloth = old_bodies.body_of(key.cloth[0]);
    collision::PinchedPairs::Key moved{key.cloth, here(key.body), key.limb};
    const auto move = [&](collision::Triangle& triangle, std::size_t body) {
      for (Index& v : triangle)
        v += bodies.surfaces()[here(body)].first_vertex - old_bodies.surfaces()[body].first_vertex;
    };
    move(moved.cloth, cloth);
    collision::PinchedPairs::Origin of_faces = origin;
    for (collision::Triangle& face : of_faces.faces) move(face, key.body);
    engine_.exempt(moved, of_faces);
  }
  for (const auto& [cloth, obstacle] : before.pinching_before_) pinching_before_.insert({here(cloth), here(obstacle)});
}

CollisionStage::Pinches CollisionStage::take_pinches(const SystemState& last_start) {
  note_pinches(last_start);
  pinching_before_ = std::move(pinching_);
  pinching_.clear();
  return std::exchange(pinches_, {});
}

template <class Archive>
void CollisionStage::serialize(Archive& archive, double t, SystemState& now) {
  place_bodies(t, now);
  engine_.serialize(archive, now.x);
  serialize_reported_pinches(archive);
}

template <class Archive>
void CollisionStage::serialize_events(Archive& archive) {
  engine_.serialize_events(archive);
  serialize_reported_pinches(archive);
}

template <class Archive>
void CollisionStage::serialize_reported_pinches(Archive& archive) {
  std::vector<PinchingObjects> before(pinching_before_.begin(), pinching_before_.end());
  serialize_each(archive, before,
                 [&](PinchingObjects& objects) { serialize_values(archive, objects.first, objects.second); });
  if constexpr (!Archive::kReads) return;
  pinching_before_ = {before.begin(), before.end()};
  pinching_.clear();
  pinches_ = {};
}

template void CollisionStage::serialize(ByteWriter&, double, SystemState&);
template void CollisionStage::serialize(ByteReader&, double, SystemState&);
template void CollisionStage::serialize_events(ByteWriter&);
template void CollisionStage::serialize_events(ByteReader&);

}  // namespace weft::simulation
