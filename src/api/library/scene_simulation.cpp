// Simulation of a scene through the public interface.
#include "film/production/scene_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <weft/scene.hpp>
#include <weft/simulation.hpp>

#include "api/library/scene_data.hpp"

namespace weft {
namespace {

// Checks the driven obstacles; throws std::invalid_argument for a wrong one. Gives each at least
// two keys, because only obstacles with two or more keys count as moving.
scene::Scene with_driven(scene::Scene scene, const SimulationOptions& options) {
  for (const std::string& name : options.driven) {
    const auto found = std::ranges::find(scene.obstacles, name, &scene::Obstacle::name);
    if (found == scene.obstacles.end())
      throw std::invalid_argument(fmt::format("driven: expected obstacles of the scene ({}), got {}",
                                              fmt::join(library::names_of(scene.obstacles), ", "), name));
    if (scene::is_dynamic(*found) && found->release.value_or(0) == 0)
      throw std::invalid_argument(fmt::format(
          "driven: expected an obstacle without a mass, or with a `release` until which it is moved, got {}", name));
    if (found->motion.keys.size() > 1) continue;
    const scene::Pose pose = found->motion.keys.empty() ? found->pose : found->motion.keys.front().pose;
    found->motion.keys = {{0, pose}, {1 / scene.time.fps, pose}};
  }
  return scene;
}

Frame::Data frame_of(const simulation::Simulation& now) {
  return library::view(static_cast<const production::SceneSimulation&>(now).snapshot());
}

}  // namespace

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(library::with_public_errors([&] {
        auto simulation = std::make_unique<production::SceneSimulation>(with_driven(scene.data().scene, options));
        return std::make_unique<Impl>(
            std::move(simulation), library::heading_of(scene.data().scene.simulation_hash, options), options, frame_of);
      })) {}

}  // namespace weft

namespace weft::library {

Frame::Data view(frame::SnapshotPtr snapshot) {
  Frame::Data data;
  data.number = snapshot->frame;
  data.time = snapshot->time;
  for (std::size_t i = 0; i < snapshot->surfaces.size(); ++i) {
    const frame::Surface& surface = *snapshot->surfaces[i];
    Object& object = data.objects.emplace_back();
    object.name = surface.name;
    static_assert(static_cast<int>(Kind::rope) == static_cast<int>(frame::ObjectKind::rope));
    object.kind = static_cast<Kind>(surface.kind);
    object.positions = view_as<Vector>(snapshot->states[i].positions);
    if (object.kind == Kind::cloth || object.kind == Kind::rope) object.rest = view_as<RestPoint>(surface.uv);
    object.triangles = surface.triangles;
  }
  data.snapshot = std::move(snapshot);
  return data;
}

}  // namespace weft::library
