#include "simulation/collision_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/archive.hpp"
#include "core/error.hpp"

namespace weft::simulation {
namespace {

// Largest contact thickness in shares of the particles' spacing. Triangles that nearly neighbour each other are at
// least 0.7 spacings apart; much more, and a sheared sheet would push against itself in its own plane.
constexpr double kThicknessOfSpacing = 0.25;

bool bodies_collide(const scene::Scene& scene) {
  const auto collides = [](const auto& body) { return body.collide; };
  return scene.contact.obstacles &&
         (std::ranges::any_of(scene.obstacles, collides) || std::ranges::any_of(scene.characters, collides));
}

std::vector<std::size_t> colliding_bodies(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::size_t> bodies;
  if (!bodies_collide(scene)) return bodies;
  for (std::size_t b = 0; b < environment.bodies.size(); ++b)
    if (environment.bodies[b].collide) bodies.push_back(b);
  return bodies;
}

// The triangles of a mesh with its vertices numbered from `first`.
std::vector<collision::Triangle> shifted(const mesh::Mesh& mesh, Index first) {
  std::vector<collision::Triangle> triangles = mesh.topology.triangles;
  for (collision::Triangle& t : triangles)
    for (Index& v : t) v += first;
  return triangles;
}

// The engine's bodies are the cloths of the scene and then what else collides.
std::vector<collision::PairFriction> friction_pairs(const scene::Scene& scene,
                                                    const environment::Environment& environment) {
  std::vector<std::string> names;
  for (const scene::Cloth& cloth : scene.cloths) names.push_back(cloth.name);
  for (std::size_t b : colliding_bodies(scene, environment)) names.push_back(environment.bodies[b].name);
  std::vector<collision::PairFriction> pairs;
  for (const scene::FrictionPair& pair : scene.contact.pairs) {
    const auto a = std::find(names.begin(), names.end(), pair.first),
               b = std::find(names.begin(), names.end(), pair.second);
    if (a == names.end() || b == names.end()) continue;  // a body that does not collide
    pairs.push_back({static_cast<std::size_t>(a - names.begin()),
                     static_cast<std::size_t>(b - names.begin()),
                     {pair.friction, pair.static_friction.value_or(pair.friction)}});
  }
  return pairs;
}

collision::BroadPhaseOptions search_options(const scene::Search& search) {
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

collision::EngineParameters engine_parameters(const scene::Scene& scene, const environment::Environment& environment) {
  const scene::Contact& contact = scene.contact;
  return {.self = contact.self,
          .obstacles = contact.obstacles,
          .stiffness = contact.stiffness,
          .friction = friction_pairs(scene, environment),
          .search = search_options(contact.search),
          .reuse = contact.search.reuse,
          .velocity_constraints = contact.response == scene::Response::velocity_constraints};
}

std::vector<collision::Body> make_bodies(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<collision::Body> bodies;
  Index first = 0;
  const auto add = [&](const mesh::Mesh& mesh, bool deformable, double thickness, double friction, bool moving = true) {
    const auto count = static_cast<Index>(mesh.positions.size());
    bodies.push_back({shifted(mesh, first), first, count, deformable, thickness, friction, moving});
    first += count;
  };
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scene::Material& material = scene.cloths[c].material;
    add(environment.cloths[c].mesh, true,
        std::min(material.thickness, kThicknessOfSpacing * environment.cloths[c].spacing), material.friction);
  }
  for (std::size_t b : colliding_bodies(scene, environment))
    add(environment.bodies[b].mesh, false, 0, environment.bodies[b].friction, environment.bodies[b].moving);
  return bodies;
}

std::vector<Vec3> start_positions(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<Vec3> x;
  for (const auto& cloth : environment.cloths)
    x.insert(x.end(), cloth.motion.positions.begin(), cloth.motion.positions.end());
  for (std::size_t b : colliding_bodies(scene, environment)) {
    const auto& positions = environment.bodies[b].motion.positions;
    x.insert(x.end(), positions.begin(), positions.end());
  }
  return x;
}

}  // namespace

bool CollisionStage::needed(const scene::Scene& scene) {
  return !scene.cloths.empty() && (scene.contact.self || bodies_collide(scene));
}

CollisionStage::CollisionStage(const scene::Scene& scene, const environment::Environment& environment,
                               const ClothSystem& system)
    : bodies_(colliding_bodies(scene, environment)),
      particles_(system.masses().size()),
      all_t0_(start_positions(scene, environment)),
      all_t1_(all_t0_),
      engine_(make_bodies(scene, environment), engine_parameters(scene, environment), all_t0_,
              {system.masses().begin(), system.masses().end()}) {
  for (const auto& cloth : environment.cloths) names_.push_back(cloth.name);
  for (std::size_t b : bodies_) names_.push_back(environment.bodies[b].name);
  if (const auto meeting = engine_.find_meeting(all_t0_))
    throw Error(
        ExitCode::scene_invalid,
        "{}: expected surfaces that are apart at the start, got {}; move one of them, or leave it out of contact",
        scene.file.string(), describe(*meeting));
}

// Which objects and triangles, and where.
std::string CollisionStage::describe(const collision::CornerPair& pair) const {
  const Vec3& at = all_t0_[static_cast<std::size_t>(pair.a[0])];
  return fmt::format("'{}' (triangle {}) and '{}' (triangle {}) touching near ({:.4g}, {:.4g}, {:.4g}) m",
                     names_[engine_.body_of(pair.a[0])], engine_.triangle_of(pair.a),
                     names_[engine_.body_of(pair.b[0])], engine_.triangle_of(pair.b), at.x(), at.y(), at.z());
}

void CollisionStage::copy_obstacles(const environment::Environment& environment, std::vector<Vec3>& all) const {
  auto place = all.begin() + static_cast<std::ptrdiff_t>(particles_);
  for (std::size_t b : bodies_) {
    const auto& positions = environment.bodies[b].motion.positions;
    place = std::copy(positions.begin(), positions.end(), place);
  }
}

void CollisionStage::begin_step(environment::Environment& environment, const integrator::State& now,
                                std::span<const integrator::HeldParticle> held, double t, double h) {
  environment.move_to(t);
  copy_obstacles(environment, all_t0_);
  environment.move_to(t + h);
  copy_obstacles(environment, all_t1_);

  movable_.assign(all_t0_.size(), 0);
  std::fill_n(movable_.begin(), particles_, std::uint8_t{1});
  for (std::size_t i = 0; i < particles_; ++i) {
    all_t0_[i] = now.x[i];
    all_t1_[i] = now.x[i] + h * now.v[i];
  }
  for (const integrator::HeldParticle& particle : held) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    all_t1_[i] = particle.x_end;
    movable_[i] = 0;
  }
  engine_.begin_step(all_t0_, all_t1_, h);
}

void CollisionStage::append_constraints(std::vector<integrator::HeldParticle>& held) const {
  for (const collision::PrescribedParticle& particle : engine_.constraints().prescribed())
    if (movable_[static_cast<std::size_t>(particle.constraint.particle)])
      held.push_back({particle.constraint, particle.x_end, particle.v_end});
}

bool CollisionStage::apart(const integrator::State& next) {
  std::copy(next.x.begin(), next.x.end(), all_t1_.begin());
  return engine_.apart(all_t0_, all_t1_);
}

std::optional<std::string> CollisionStage::push_apart(double h, bool may_pinch, integrator::State& next) {
  const collision::SeparationReport report = engine_.push_apart(all_t0_, all_t1_, movable_, may_pinch);
  if (!report.separated) return "cannot keep " + describe(report.stuck) + " apart";
  for (std::size_t i = 0; i < particles_; ++i) {
    next.v[i] += (all_t1_[i] - next.x[i]) / h;
    next.x[i] = all_t1_[i];
  }
  note_pinches();
  return std::nullopt;
}

std::string CollisionStage::describe(const collision::Pinch& pinch) const {
  const std::string& obstacle = names_[pinch.obstacle];
  const std::string between = !pinch.other ? fmt::format("before '{}'", obstacle)
                              : *pinch.other == pinch.obstacle
                                  ? fmt::format("between parts of '{}'", obstacle)
                                  : fmt::format("between '{}' and '{}'", obstacle, names_[*pinch.other]);
  return fmt::format("'{}' has no room {} near ({:.4g}, {:.4g}, {:.4g}) m", names_[pinch.cloth], between,
                     pinch.place.x(), pinch.place.y(), pinch.place.z());
}

void CollisionStage::note_pinches() {
  if (engine_.pinched_pairs() == 0) return;
  pinches_.pairs = std::max(pinches_.pairs, engine_.pinched_pairs());
  for (const collision::Pinch& pinch : engine_.pinches(all_t0_)) {
    const PinchingObjects objects{pinch.cloth, pinch.obstacle};
    if (pinching_.insert(objects).second && !pinching_before_.contains(objects))
      pinches_.begun.push_back(describe(pinch));
  }
}

CollisionStage::Pinches CollisionStage::take_pinches() {
  note_pinches();
  pinching_before_ = std::move(pinching_);
  pinching_.clear();
  return std::exchange(pinches_, {});
}

template <class Archive>
void CollisionStage::exchange(Archive& archive, const environment::Environment& environment,
                              const integrator::State& now) {
  std::vector<Vec3> all = all_t0_;
  std::copy(now.x.begin(), now.x.end(), all.begin());
  copy_obstacles(environment, all);
  engine_.exchange(archive, all);
  std::vector<PinchingObjects> before(pinching_before_.begin(), pinching_before_.end());
  exchange_each(archive, before,
                [&](PinchingObjects& objects) { exchange_values(archive, objects.first, objects.second); });
  pinching_before_ = {before.begin(), before.end()};
}

template void CollisionStage::exchange(ByteWriter&, const environment::Environment&, const integrator::State&);
template void CollisionStage::exchange(ByteReader&, const environment::Environment&, const integrator::State&);

}  // namespace weft::simulation
