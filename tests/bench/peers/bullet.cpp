// bench_bullet: for comparison, simulates a scene of one cloth, a sphere and a floor with Bullet's soft body. Prints
// the cost of a frame, and writes meshes for weft_judge. `weft bench speed --peer` runs it beside Weft. Mesh, masses,
// obstacles and friction are those of the scene. The material is Bullet's, with rigid threads and soft bending, as
// usual for its soft bodies.
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "bench/measure.hpp"
#include "core/memory.hpp"
#include "core/timer.hpp"
#include "physics/mesh/ply.hpp"
#include "support/scene_runs.hpp"

namespace {

using namespace weft;

struct Request {
  std::string scene;
  std::vector<std::string> overrides;
  std::filesystem::path meshes;
  int end = 76;           // frame after the last one
  int steps = 10;         // per frame
  int iterations = 10;    // of the position solver, per step
  double margin = 0.005;  // distance that nodes keep from obstacles [m]
  double bending = 0.1;   // stiffness of links across two edges, relative to Bullet's maximum
};

btVector3 bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Bullet's world; the order of the members is the order of construction.
struct World {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::unique_ptr<btSoftBody> cloth;

  ~World() {
    if (cloth) world.removeSoftBody(cloth.get());
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
};

void add_obstacles(World& world, const scene::Scene& scene) {
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    btTransform place = btTransform::getIdentity();
    if (const auto* sphere = std::get_if<scene::Sphere>(&obstacle.shape)) {
      world.shapes.push_back(std::make_unique<btSphereShape>(static_cast<btScalar>(sphere->radius)));
      place.setOrigin(bullet(obstacle.pose.position));
    } else if (std::holds_alternative<scene::Plane>(obstacle.shape)) {
      const btVector3 up = scene.up == scene::UpAxis::z ? btVector3(0, 0, 1) : btVector3(0, 1, 0);
      world.shapes.push_back(std::make_unique<btStaticPlaneShape>(up, bullet(obstacle.pose.position).dot(up)));
    } else {
      throw std::invalid_argument("obstacle " + obstacle.name + ": expected a sphere or a plane");
    }
    const btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, world.shapes.back().get());
    world.bodies.push_back(std::make_unique<btRigidBody>(info));
    world.bodies.back()->setWorldTransform(place);
    world.bodies.back()->setFriction(static_cast<btScalar>(obstacle.friction));
    world.world.addRigidBody(world.bodies.back().get());
  }
}

void add_cloth(World& world, const Request& request, const scene::Scene& scene,
               const production::SceneSimulation& start) {
  const simulation::ParticleState state = start.state();
  std::vector<btVector3> places;
  std::vector<btScalar> masses;
  for (const Vec3& x : state.positions) places.push_back(bullet(x));
  for (const double mass : state.masses) masses.push_back(static_cast<btScalar>(mass));
  btSoftBodyWorldInfo& info = world.world.getWorldInfo();
  info.m_gravity = bullet(scene.physics.gravity);
  info.air_density = 0;
  // Bullet samples obstacles on a grid: with the default of 0.25 m, a ball of 0.2 m loses a quarter of its radius.
  info.m_sparsesdf.Initialize();
  info.m_sparsesdf.setDefaultVoxelsz(0.02F);
  info.m_sparsesdf.Reset();
  world.world.setGravity(info.m_gravity);
  world.cloth = std::make_unique<btSoftBody>(&info, static_cast<int>(places.size()), places.data(), masses.data());
  btSoftBody& cloth = *world.cloth;
  std::set<std::pair<Index, Index>> edges;
  for (const auto& triangle : start.snapshot()->surfaces[0]->triangles) {
    cloth.appendFace(triangle[0], triangle[1], triangle[2]);
    for (std::size_t c = 0; c < 3; ++c) edges.insert(std::minmax(triangle[c], triangle[(c + 1) % 3]));
  }
  for (const auto& [a, b] : edges) cloth.appendLink(a, b);
  btSoftBody::Material* bending = cloth.appendMaterial();
  bending->m_kLST = static_cast<btScalar>(request.bending);
  cloth.generateBendingConstraints(2, bending);
  cloth.m_cfg.piterations = request.iterations;
  cloth.m_cfg.kDF = static_cast<btScalar>(scene.cloths[0].material.friction);
  cloth.getCollisionShape()->setMargin(static_cast<btScalar>(request.margin));
  cloth.setActivationState(DISABLE_DEACTIVATION);
  world.world.addSoftBody(&cloth);
}

// Writes meshes as `weft run --meshes` does.
void write_meshes(const Request& request, const frame::FrameSnapshot& start, const btSoftBody& cloth, int frame) {
  if (request.meshes.empty()) return;
  for (std::size_t s = 0; s < start.surfaces.size(); ++s) {
    std::vector<Vec3> x = start.states[s].positions;
    for (int i = 0; s == 0 && i < cloth.m_nodes.size(); ++i) {
      const btVector3& place = cloth.m_nodes[i].m_x;
      x[static_cast<std::size_t>(i)] = {place.x(), place.y(), place.z()};
    }
    char name[32];
    std::snprintf(name, sizeof name, "_%05d.ply", frame);
    mesh::write_ply(request.meshes / (start.surfaces[s]->name + name), x, start.surfaces[s]->triangles);
  }
}

void run(const Request& request) {
  const scene::Scene scene = support::scene_of(request.scene, request.overrides);
  if (scene.cloths.size() != 1 || !scene.characters.empty())
    throw std::invalid_argument("expected a scene of one cloth and no character");
  const production::SceneSimulation start(scene);
  World world;
  add_obstacles(world, scene);
  add_cloth(world, request, scene, start);
  write_meshes(request, *start.snapshot(), *world.cloth, 0);
  const auto h = static_cast<btScalar>(1 / scene.time.fps / request.steps);
  std::vector<double> after_contact;
  double all = 0;
  bool touched = false;
  for (int k = 1; k < request.end; ++k) {
    const double begin = process_cpu_seconds();
    for (int s = 0; s < request.steps; ++s) {
      world.world.stepSimulation(h, 1, h);
      touched = touched || world.cloth->m_rcontacts.size() > 0;
    }
    const double ms = 1e3 * (process_cpu_seconds() - begin);
    all += ms;
    if (touched) after_contact.push_back(ms);
    write_meshes(request, *start.snapshot(), *world.cloth, k);
  }
  std::printf("%zu particles, %d frames of %d steps: %.2f CPU ms a frame, %.1f (median) after first contact; %.0f MB\n",
              start.particles(), request.end - 1, request.steps, all / std::max(1, request.end - 1),
              after_contact.empty() ? 0 : bench::median(after_contact),
              1e-6 * static_cast<double>(peak_memory_bytes()));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulates a scene of one cloth, spheres and planes with Bullet's soft body.");
  Request request;
  app.add_option("SCENE", request.scene)->required()->check(CLI::ExistingFile);
  app.add_option("--set", request.overrides, "KEY=VALUE; repeatable")->expected(1)->take_all();
  app.add_option("--meshes", request.meshes, "folder for PLY files");
  app.add_option("--end", request.end, "frame after the last one");
  app.add_option("--steps", request.steps, "a frame")->check(CLI::PositiveNumber);
  app.add_option("--iterations", request.iterations, "of the position solver, a step")->check(CLI::PositiveNumber);
  app.add_option("--margin", request.margin, "that nodes keep from obstacles [m]");
  app.add_option("--bending", request.bending, "stiffness of links across two edges, a share");
  CLI11_PARSE(app, argc, argv);
  try {
    run(request);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_bullet: %s\n", error.what());
    return 2;
  }
}
