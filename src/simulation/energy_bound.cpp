#include "simulation/energy_bound.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "simulation/collision_stage.hpp"

namespace weft::simulation {
namespace {

// Share of the energies in play that may have been gained. A run of the midpoint rule that explodes gains all of them
// within some frames; the worst of what the tolerance of Newton's method did on the stability map is 0.07.
constexpr double kGain = 0.3;
// And that is warned of.
constexpr double kDoubtfulGain = 0.1;
// Below this it is rounding [J].
constexpr double kRounding = 1e-9;

bool is_alone(const scene::Scene& scene) {
  const auto moves = [](const auto& track) { return track.keys.size() > 1; };
  for (const scene::Cloth& cloth : scene.cloths) {
    const bool sewn = cloth.shape == scene::ClothShape::pattern || cloth.shape == scene::ClothShape::mesh;
    if (sewn && cloth.sewing > 0) return false;  // that drives it
    if (!cloth.over.empty()) return false;       // comes later
    for (const scene::Pin& pin : cloth.pins)
      if (moves(pin.motion) || !pin.follow.empty()) return false;
  }
  const auto stands = [&](const scene::Obstacle& obstacle) { return !obstacle.collide || !moves(obstacle.motion); };
  if (!scene.characters.empty() || !std::ranges::all_of(scene.obstacles, stands)) return false;
  return scene.physics.air_density == 0 || (scene.physics.wind == Vec3::Zero() && scene.physics.gusts.speed == 0);
}

double mechanical(const FrameReport& report) {
  return report.kinetic_energy + report.potential_energy + report.elastic_energy;
}

}  // namespace

EnergyBound::EnergyBound(const scene::Scene& scene, const FrameReport& start)
    : applies_(is_alone(scene)),
      damped_contact_(CollisionStage::needed(scene) && scene.time.integrator != scene::Integrator::implicit_midpoint),
      integrator_(scene.time.integrator),
      start_(mechanical(start)),
      moving_(start.kinetic_energy),
      elastic_(start.elastic_energy),
      potential_low_(start.potential_energy),
      potential_high_(start.potential_energy) {}

std::optional<std::string> EnergyBound::check(int frame, const FrameReport& energies) {
  if (!applies_) return {};
  potential_low_ = std::min(potential_low_, energies.potential_energy);
  potential_high_ = std::max(potential_high_, energies.potential_energy);
  const double in_play = moving_ + elastic_ + potential_high_ - potential_low_;
  const double gain = mechanical(energies) - start_;
  const auto is_above = [&](double share) { return gain > share * in_play + kRounding; };
  const bool refused = is_above(kGain) && !damped_contact_;
  if (!refused && (warned_ || !is_above(kDoubtfulGain))) return {};
  const std::string text = fmt::format(
      "frame {}: the cloth has {:.3g} J more than at the start, with {:.3g} J in play and nothing that drives it; try "
      "a smaller time.step or solver.newton_tolerance{}",
      frame, gain, in_play,
      integrator_ == scene::Integrator::implicit_midpoint
          ? ", or integrator = \"bdf2\": the midpoint rule damps nothing"
          : "");
  if (refused) throw Error(ExitCode::simulation_failed, "{}", text);
  warned_ = true;
  return text;
}

}  // namespace weft::simulation
