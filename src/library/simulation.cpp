#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <weft/simulation.hpp>

#include "core/nearest.hpp"
#include "core/version.hpp"
#include "library/data.hpp"
#include "production/scene_simulation.hpp"

namespace weft {
namespace {

// An obstacle counts as moving if it has two keys or more, so a driven obstacle needs at least two.
void add_keys(scene::Scene& scene, scene::Obstacle& obstacle) {
  if (obstacle.motion.keys.size() > 1) return;
  const scene::Pose pose = obstacle.motion.keys.empty() ? obstacle.pose : obstacle.motion.keys.front().pose;
  obstacle.motion.keys = {{0, pose}, {1 / scene.time.fps, pose}};
}

std::string first_line(const scene::Scene& scene, const SimulationOptions& options) {
  return fmt::format("weft {} {:016x} {}\n", kVersion, scene.simulation_hash, fmt::join(options.driven, ","));
}

}  // namespace

struct Simulation::Impl {
  Impl(const Scene& public_scene, const SimulationOptions& options);

  std::size_t obstacle(std::string_view name) const;
  void update_current_frame(const simulation::FrameReport& report);

  scene::Scene scene;
  std::string heading;              // first line of a saved state
  std::vector<std::size_t> driven;  // numbers of the driven obstacles
  std::unique_ptr<production::SceneSimulation> simulation;
  std::optional<Frame> current;
};

Simulation::Impl::Impl(const Scene& public_scene, const SimulationOptions& options)
    : scene(public_scene.data().scene), heading(first_line(scene, options)) {
  for (const std::string& name : options.driven) {
    driven.push_back(obstacle(name));
    add_keys(scene, scene.obstacles[driven.back()]);
  }
  simulation = std::make_unique<production::SceneSimulation>(scene);
  if (options.state.empty()) {
    simulation->run_preroll();
    update_current_frame(simulation->initial_report());
    return;
  }
  if (!options.state.starts_with(heading))
    throw std::invalid_argument(
        "state: expected one that this version saved for this scene and these driven obstacles");
  for (const std::size_t o : driven) simulation->drive(o, {});
  try {
    simulation->restore(std::string_view(options.state).substr(heading.size()));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(std::string("state: ") + error.what());
  }
  update_current_frame({});
}

// Number of an obstacle. Throws std::invalid_argument with the names of all obstacles if there is none of this name.
std::size_t Simulation::Impl::obstacle(std::string_view name) const {
  const auto found = std::ranges::find(scene.obstacles, name, &scene::Obstacle::name);
  if (found != scene.obstacles.end()) return static_cast<std::size_t>(found - scene.obstacles.begin());
  std::vector<std::string> names;
  for (const scene::Obstacle& known : scene.obstacles) names.push_back(known.name);
  throw std::invalid_argument(
      fmt::format("expected an obstacle of the scene ({}), got {}", fmt::join(names, ", "), name));
}

void Simulation::Impl::update_current_frame(const simulation::FrameReport& report) {
  Frame::Data data;
  data.snapshot = simulation->snapshot();
  data.report = library::report_of(report);
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    simulation::ClothMotion motion = simulation->motion_of(c);
    data.velocities.emplace_back(motion.velocities.begin(), motion.velocities.end());
    data.strains.push_back(std::move(motion.strains));
  }
  data.contact_forces = simulation->contact_forces();
  current = library::make_frame(std::move(data));
}

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(library::with_public_errors([&] { return std::make_unique<Impl>(scene, options); })) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Frame& Simulation::frame() const {
  return *impl_->current;
}

const Frame& Simulation::advance() {
  library::with_public_errors([&] { impl_->update_current_frame(impl_->simulation->advance()); });
  return frame();
}

void Simulation::move(std::string_view obstacle, const Pose& pose) {
  const std::size_t number = impl_->obstacle(obstacle);
  if (std::ranges::find(impl_->driven, number) == impl_->driven.end())
    throw std::invalid_argument(fmt::format("expected {} among SimulationOptions::driven", obstacle));
  const auto& [w, x, y, z] = pose.rotation;
  const scene::Pose end{Vec3(pose.position.data()), Quat(w, x, y, z)};
  if (!end.position.allFinite() || !(std::abs(end.rotation.norm() - 1) < 1e-6))
    throw std::invalid_argument(
        fmt::format("{}: expected a finite position [m] and a unit quaternion w, x, y, z, got [{}] and [{}]", obstacle,
                    fmt::join(pose.position, ", "), fmt::join(pose.rotation, ", ")));
  impl_->simulation->drive(number, end);
}

std::string Simulation::save() const {
  std::string bytes = impl_->heading;
  impl_->simulation->save(bytes);
  return bytes;
}

}  // namespace weft
