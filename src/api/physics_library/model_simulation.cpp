// Simulation of a model through the public interface.
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <weft/simulation.hpp>

#include "api/physics_library/data.hpp"
#include "api/physics_library/model_bytes.hpp"
#include "api/physics_library/model_input.hpp"

namespace weft {
namespace {

// Data that do not change during a simulation. All frames share them.
struct Meshes {
  explicit Meshes(const model::Model& model) {
    for (const model::Cloth& cloth : model.cloths) {
      names.push_back(cloth.name);
      triangles.push_back(cloth.mesh.topology.triangles);
      rest.push_back(cloth.mesh.uv);
    }
    for (const model::Body& body : model.bodies) {
      names.push_back(body.name);
      triangles.push_back(body.mesh.topology.triangles);
    }
  }
  std::vector<std::string> names;
  std::vector<std::vector<mesh::Triangle>> triangles;
  std::vector<std::vector<Vec2>> rest;  // of cloths
};

struct Positions {
  std::shared_ptr<const Meshes> meshes;
  std::vector<Vec3> particles;               // of all cloths
  std::vector<std::vector<Vec3>> of_bodies;  // vertices
};

Frame::Data frame_of(const simulation::Simulation& now, const std::shared_ptr<const Meshes>& meshes) {
  auto positions = std::make_shared<Positions>(Positions{meshes, now.particles_of_all(), {}});
  for (std::size_t b = 0; b < now.model().bodies.size(); ++b) {
    std::vector<Vec3>& x = positions->of_bodies.emplace_back(now.vertices_of(b));
    if (!x.empty()) continue;
    x.resize(now.model().bodies[b].mesh.positions.size());
    now.model().place(b, now.time(), x);
  }
  Frame::Data data;
  const std::size_t cloths = meshes->rest.size();
  std::span<const Vector> particles = library::view_as<Vector>(positions->particles);
  for (std::size_t i = 0; i < meshes->names.size(); ++i) {
    Object& object = data.objects.emplace_back();
    object.name = meshes->names[i];
    object.kind = i < cloths ? Kind::cloth : Kind::obstacle;
    object.triangles = meshes->triangles[i];
    if (i >= cloths) {
      object.positions = library::view_as<Vector>(positions->of_bodies[i - cloths]);
      continue;
    }
    object.rest = library::view_as<RestPoint>(meshes->rest[i]);
    object.positions = particles.first(object.rest.size());
    particles = particles.subspan(object.rest.size());
  }
  data.viewed = std::move(positions);
  return data;
}

// FNV-1a, 64 bits (Fowler, Noll & Vo).
std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace

Simulation::Simulation(const Model& model, const SimulationOptions& options)
    : impl_(library::with_public_errors([&] {
        model::Model physics = library::physics_of(model, options.driven);
        const auto meshes = std::make_shared<const Meshes>(physics);
        return std::make_unique<Impl>(std::make_unique<simulation::Simulation>(std::move(physics)),
                                      library::heading_of(hash_of(library::bytes_of(model)), options), options,
                                      [meshes](const simulation::Simulation& now) { return frame_of(now, meshes); });
      })) {}

}  // namespace weft
