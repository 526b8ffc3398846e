// Simulation of a model through the public interface.
#include <memory>
#include <string_view>
#include <utility>
#include <weft/simulation.hpp>

#include "api/physics_library/data.hpp"
#include "api/physics_library/model_input.hpp"

namespace weft {
namespace {

// What stays the same over a run, and all frames share.
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
  std::vector<std::vector<Vec3>> of_objects;
};

Frame::Data frame_of(const simulation::Simulation& now, const std::shared_ptr<const Meshes>& meshes) {
  auto positions = std::make_shared<Positions>(Positions{meshes, {}});
  const std::vector<Vec3> particles = now.particles_of_all();
  auto next = particles.begin();
  for (const model::Cloth& cloth : now.model().cloths) {
    const auto end = next + static_cast<std::ptrdiff_t>(cloth.start.size());
    positions->of_objects.emplace_back(next, end);
    next = end;
  }
  for (std::size_t b = 0; b < now.model().bodies.size(); ++b) {
    std::vector<Vec3>& x = positions->of_objects.emplace_back(now.vertices_of(b));
    if (!x.empty()) continue;
    x.resize(now.model().bodies[b].mesh.positions.size());
    now.model().place(b, now.time(), x);
  }
  Frame::Data data;
  for (std::size_t i = 0; i < meshes->names.size(); ++i) {
    Object& object = data.objects.emplace_back();
    object.name = meshes->names[i];
    object.kind = i < meshes->rest.size() ? Kind::cloth : Kind::obstacle;
    object.positions = library::view_as<Vector>(positions->of_objects[i]);
    if (i < meshes->rest.size()) object.rest = library::view_as<RestPoint>(meshes->rest[i]);
    object.triangles = meshes->triangles[i];
  }
  data.viewed = std::move(positions);
  return data;
}

// FNV-1a, 64 bits (Fowler, Noll & Vo), of the meshes: enough to refuse the state of another model.
std::uint64_t hash_of(const model::Model& model) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&](const void* bytes, std::size_t size) {
    for (const char c : std::string_view(static_cast<const char*>(bytes), size))
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  };
  const auto add_mesh = [&](const mesh::Mesh& mesh) {
    add(mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
    add(mesh.topology.triangles.data(), mesh.topology.triangles.size() * sizeof(mesh::Triangle));
  };
  for (const model::Cloth& cloth : model.cloths) add_mesh(cloth.mesh);
  for (const model::Body& body : model.bodies) add_mesh(body.mesh);
  return hash;
}

}  // namespace

Simulation::Simulation(const Model& given, const SimulationOptions& options)
    : impl_(library::with_public_errors([&] {
        model::Model model = library::physics_of(given, options.driven);
        const std::uint64_t hash = hash_of(model);
        const auto meshes = std::make_shared<const Meshes>(model);
        return std::make_unique<Impl>(std::make_unique<simulation::Simulation>(std::move(model)),
                                      library::heading_of(hash, options), options,
                                      [meshes](const simulation::Simulation& now) { return frame_of(now, meshes); });
      })) {}

}  // namespace weft
