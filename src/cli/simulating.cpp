#include "cli/simulating.hpp"

#include <utility>

#include "cli/scene_input.hpp"
#include "scene/loader.hpp"

namespace weft::cli {

Job::Plan SimulatingJob::load() {
  scene_ = load_scene(options_.common);
  Plan plan;
  plan.settings = render_settings(scene_, options_.common);
  plan.scene = manifest_of(scene_, plan.settings);
  plan.scene_text = scene::effective_scene(scene_);
  plan.wanted = resolve_frames(options_.frames, scene_.frame_count());
  plan.made = {0, plan.wanted.last() + 1, 1};
  plan.simulated = scene_.preroll_frames() + plan.made.count();
  return plan;
}

std::vector<std::string> SimulatingJob::object_names() const {
  std::vector<std::string> names;
  for (const scene::Cloth& cloth : scene_.cloths) names.push_back(cloth.name);
  for (const scene::Obstacle& obstacle : scene_.obstacles) names.push_back(obstacle.name);
  for (const scene::Character& character : scene_.characters) names.push_back(character.name);
  return names;
}

void SimulatingJob::open_store(std::filesystem::path folder, Store::Need need, const Plan& plan) {
  store_.emplace(std::move(folder), need, plan.scene, plan.scene_text);
  if (options_.resume) store_->find_start();
}

std::unique_ptr<FrameSource> SimulatingJob::make_source(std::function<bool()> proceed) {
  return std::make_unique<StoredSimulation>(scene_, *store_, std::move(proceed));
}

void SimulatingJob::conclude(RunReport& report) {
  report.cache = store_->time();
  report.cache_bytes = store_->bytes();
}

std::string SimulatingJob::way_on(ExitCode code) const {
  // A simulation that cannot go on will not be able to again.
  if (code == ExitCode::simulation_failed || !store_->can_resume()) return "";
  return "the same command with --resume goes on from there";
}

}  // namespace weft::cli
