// Simulation of a model through the public interface.
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <weft/simulation.hpp>

#include "api/physics_library/data.hpp"
#include "api/physics_library/material_members.hpp"
#include "api/physics_library/model_input.hpp"

namespace weft {
namespace {

// Data that stay the same during a run and that all frames share.
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

// FNV-1a, 64 bits (Fowler, Noll & Vo), of all members of a model.
class Hash {
 public:
  std::uint64_t value() const { return hash_; }

  void add(const Model& model) {
    add_all(model.fps, model.step, model.method, model.newton_tolerance, model.gravity, model.wind, model.air_density,
            model.self_contact);
    add_list(model.cloths, [&](const Cloth& cloth) {
      add_mesh(cloth.mesh);
      add_text(cloth.name);
      add_list(cloth.rest, [&](const RestPoint& point) { add_all(point); });
      for (const library::MaterialMember& member : library::kMaterialMembers) add_all(cloth.material.*member.given);
      add_all(cloth.velocity);
    });
    add_list(model.bodies, [&](const Body& body) {
      add_mesh(body.mesh);
      add_text(body.name);
      add_all(body.pose.position, body.pose.rotation, body.mass, body.velocity, body.friction, body.collide);
      add_list(body.keys, [&](const PoseKey& key) { add_all(key.time, key.pose.position, key.pose.rotation); });
    });
    add_list(model.pins, [&](const Pin& pin) {
      add_text(pin.cloth);
      add_text(pin.body);
      add_all(pin.release);
      add_list(pin.particles, [&](int i) { add_all(i); });
    });
  }

 private:
  // Values without padding: numbers, and arrays of them.
  template <class... Values>
  void add_all(const Values&... values) {
    (add_bytes(&values, sizeof values), ...);
  }
  void add_bytes(const void* bytes, std::size_t size) {
    for (const char c : std::string_view(static_cast<const char*>(bytes), size))
      hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  void add_text(const std::string& text) {
    add_all(text.size());
    add_bytes(text.data(), text.size());
  }
  template <class List, class Add>
  void add_list(const List& list, const Add& add_one) {
    add_all(list.size());
    for (const auto& each : list) add_one(each);
  }
  void add_mesh(const Mesh& mesh) {
    add_list(mesh.positions, [&](const Vector& x) { add_all(x); });
    add_list(mesh.triangles, [&](const Triangle& t) { add_all(t); });
  }

  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

}  // namespace

Simulation::Simulation(const Model& model, const SimulationOptions& options)
    : impl_(library::with_public_errors([&] {
        model::Model physics = library::physics_of(model, options.driven);
        Hash hash;
        hash.add(model);
        const auto meshes = std::make_shared<const Meshes>(physics);
        return std::make_unique<Impl>(std::make_unique<simulation::Simulation>(std::move(physics)),
                                      library::heading_of(hash.value(), options), options,
                                      [meshes](const simulation::Simulation& now) { return frame_of(now, meshes); });
      })) {}

}  // namespace weft
