#include "film/production/scene_simulation.hpp"

#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "film/environment/environment.hpp"
#include "film/environment/growing.hpp"
#include "film/production/pin_warnings.hpp"
#include "film/production/plan.hpp"

namespace weft::production {

/// Environment and simulation of a scene at its start.
struct SceneSimulation::Start {
  const scene::Scene& scene;
  environment::Environment environment;
  Simulation simulation;

  static Start of(const scene::Scene& scene) {
    environment::Environment environment(scene);
    const auto posed = environment::pose_arms_for_sleeves(scene, environment);
    if (posed) environment = environment::Environment(*posed);
    try {
      Simulation simulation(environment.model);
      return {scene, std::move(environment), std::move(simulation)};
    } catch (const Error& error) {
      if (error.code() != ExitCode::scene_invalid) throw;
      std::vector<std::string> notes;
      const auto growing = environment::let_wearers_grow(posed ? *posed : scene, environment, notes);
      if (!growing) throw;
      environment::Environment grown(*growing);
      Simulation simulation(grown.model);  // throws if another cloth, without a growing wearer, cannot be untangled
      for (const std::string& note : notes) log::note(note);
      return {scene, std::move(grown), std::move(simulation)};
    }
  }
};

SceneSimulation::SceneSimulation(const scene::Scene& scene) : SceneSimulation(Start::of(scene)) {}

SceneSimulation::SceneSimulation(Start start)
    : Simulation(std::move(start.simulation)), maker_(start.scene, start.environment), heat_(start.scene.render.heat) {
  for (const auto& texts : {find_undrawn(start.scene), find_jumps(start.scene, start.environment)})
    for (const std::string& text : texts) log::warn(text);
}

frame::SnapshotPtr SceneSimulation::snapshot() const {
  if (current_ && current_changes_ == changes()) return current_;
  std::vector<std::vector<Vec3>> moved;
  for (std::size_t b = 0; b < model().bodies.size(); ++b) moved.push_back(vertices_of(b));
  current_ = maker_.make(frame(), time(), model(), particles_of_all(), heat(), std::move(moved));
  current_changes_ = changes();
  return current_;
}

// The quantity that heat colours show, per cloth and particle. Empty without heat colours, and until all cloths are put
// on.
std::vector<std::vector<float>> SceneSimulation::heat() const {
  std::vector<std::vector<float>> heat;
  for (std::size_t c = 0; c < model().cloths.size() && heat_ != scene::HeatQuantity::none && all_put_on(); ++c) {
    simulation::ClothMotion motion = motion_of(c);
    if (heat_ == scene::HeatQuantity::strain) {
      heat.push_back(std::move(motion.strains));
      continue;
    }
    heat.emplace_back();
    for (const Vec3& v : motion.velocities) heat.back().push_back(static_cast<float>(v.norm()));
  }
  return heat;
}

std::vector<frame::ObjectInfo> SceneSimulation::objects() const {
  std::vector<frame::ObjectInfo> objects;
  for (const model::Cloth& cloth : model().cloths)
    objects.push_back(
        {cloth.name, cloth.rope ? frame::ObjectKind::rope : frame::ObjectKind::cloth, cloth.mesh.positions.size(),
         cloth.mesh.topology.quads.empty() ? cloth.mesh.topology.triangles.size() : cloth.mesh.topology.quads.size()});
  for (const model::Body& body : model().bodies)
    objects.push_back({body.name, body.deforms() ? frame::ObjectKind::character : frame::ObjectKind::obstacle,
                       body.mesh.positions.size(), body.mesh.topology.triangles.size()});
  return objects;
}

StartView view_start(const scene::Scene& scene) {
  const environment::Environment environment(scene);
  const model::Model& model = environment.model;
  StartView view;
  std::vector<Vec3> particles;
  for (const model::Cloth& cloth : model.cloths)
    particles.insert(particles.end(), cloth.start.begin(), cloth.start.end());
  view.snapshot =
      SnapshotMaker(scene, environment).make(-model.time.preroll_frames, model.start_time(), model, particles, {});
  view.places = simulation::find_start_intersections(model);
  if (!view.places.empty()) view.description = simulation::describe(view.places);
  return view;
}

}  // namespace weft::production
