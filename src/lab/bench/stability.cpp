#include "lab/bench/stability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "film/production/scene_simulation.hpp"

namespace weft::bench {
namespace {

// Increase of energy that is allowed in addition to the driven energy: kSolverEnergyRatio times the energies in play,
// for errors of the solver, plus kEnergyRounding [J].
constexpr double kSolverEnergyRatio = 0.1, kEnergyRounding = 1e-9;

double mechanical_energy(const simulation::FrameReport& report) {
  return report.kinetic_energy + report.potential_energy + report.elastic_energy;
}

/// Checks positions and energy of a run in each frame, and records the largest speed and energy gain.
class RunMonitor {
 public:
  RunMonitor(const scene::Scene& scene, const production::SceneSimulation& simulation, double driven)
      : cloths_(scene.cloths.size()), fps_(scene.time.fps), driven_(driven), before_(simulation.snapshot()) {
    const simulation::FrameReport start = simulation.initial_report();
    start_energy_ = mechanical_energy(start);
    largest_energy_ = start.kinetic_energy + start.elastic_energy;
    potential_low_ = potential_high_ = start.potential_energy;
  }

  // Updates `outcome` with the next frame. Returns false if a position or the energy is not finite.
  bool check_frame(const simulation::FrameReport& report, const frame::SnapshotPtr& snapshot, Outcome& outcome) {
    for (std::size_t c = 0; c < cloths_; ++c) {
      const auto& x = snapshot->states[c].positions;
      const auto& x_before = before_->states[c].positions;
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (!x[i].allFinite()) return false;
        outcome.max_speed = std::max(outcome.max_speed, fps_ * (x[i] - x_before[i]).norm());
      }
    }
    before_ = snapshot;
    const double energy = mechanical_energy(report);
    if (!std::isfinite(energy)) return false;
    // Energies in play: the larger of kinetic + elastic energy at the start and the largest elastic energy so far, plus
    // the range of potential energy so far.
    largest_energy_ = std::max(largest_energy_, report.elastic_energy);
    potential_low_ = std::min(potential_low_, report.potential_energy);
    potential_high_ = std::max(potential_high_, report.potential_energy);
    const double allowed =
        driven_ + kEnergyRounding + kSolverEnergyRatio * (largest_energy_ + potential_high_ - potential_low_);
    outcome.energy_gain = std::max(outcome.energy_gain, (energy - start_energy_) / allowed);
    return true;
  }

 private:
  std::size_t cloths_;
  double fps_, driven_;
  frame::SnapshotPtr before_;
  double start_energy_ = 0, largest_energy_ = 0, potential_low_ = 0, potential_high_ = 0;
};

void run(const scene::Scene& scene, int frames, double driven, Outcome& outcome) {
  production::SceneSimulation simulation(scene);
  RunMonitor monitor(scene, simulation, driven);
  bool warned = false;
  for (int k = 0; k < frames; ++k) {
    const simulation::FrameReport report = simulation.advance();
    ++outcome.frames;
    warned = warned || !report.warnings.empty();
    outcome.steps += report.steps;
    outcome.rejected_steps += report.rejected_steps;
    outcome.newton_iterations += report.newton_iterations;
    outcome.max_strain = report.max_strain;
    if (!monitor.check_frame(report, simulation.snapshot(), outcome)) {
      outcome.verdict = Verdict::not_finite;
      return;
    }
  }
  if (outcome.energy_gain > 1) outcome.verdict = warned ? Verdict::warned : Verdict::unbounded;
}

}  // namespace

std::string_view describe(Verdict verdict) {
  constexpr std::string_view kNames[kVerdicts] = {"solved", "refused", "warned of", "unbounded", "not finite"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Outcome try_scene(const scene::Scene& scene, int frames, double driven) {
  Outcome outcome;
  const double start = thread_cpu_seconds();
  try {
    run(scene, frames, driven, outcome);
  } catch (const Error& error) {
    outcome.verdict = Verdict::refused;
    outcome.reason = error.what();
  }
  outcome.cpu_s = thread_cpu_seconds() - start;
  return outcome;
}

namespace {

// Side [m], density [kg/m²], and number of particles along each side of the square sheet of the map.
constexpr double kWidth = 0.5, kDensity = 0.2;
constexpr int kParticles = 11;

scene::Scene swing(scene::Integrator integrator, double stiffness, double step) {
  scene::Scene scene;
  scene.name = "swing";
  // There is one frame every 40 ms; if steps are longer, one frame per step.
  scene.time = {.duration = 1000, .fps = 1 / std::max(step, 0.04), .step = step, .integrator = integrator};
  scene.contact.self = scene.contact.obstacles = false;
  scene::Cloth cloth;
  cloth.name = "sheet";
  cloth.size = {kWidth, kWidth};
  cloth.particles_weft = cloth.particles_warp = kParticles;
  // No named fabric is used, so that new data of fabrics do not change the map.
  scene::Material& material = cloth.material;
  material.density = kDensity;
  material.stretch_weft = material.stretch_warp = stiffness;
  material.shear = 100;
  material.bend = 5e-5;
  material.bend_viscosity = 5e-6;
  material.bend_friction = 2e-4;
  material.max_stretch = 0;  // threads do not lock, so only the stretch stiffness, which the map varies, resists
  scene::Pin left, right;
  left.low = left.high = {0, 1};
  right.low = right.high = {1, 1};
  cloth.pins = {left, right};
  scene.cloths.push_back(cloth);
  return scene;
}

}  // namespace

double swing_period() {
  return 2 * std::numbers::pi * std::sqrt(2 * kWidth / (3 * 9.81));
}

double stiffest_period(double stiffness) {
  const double spacing = kWidth / (kParticles - 1);
  return std::numbers::pi * spacing * std::sqrt(kDensity / stiffness);
}

std::vector<MapCell> stability_map(const std::function<void(const MapCell&)>& each) {
  constexpr double kSteps[] = {1e-5, 1e-4, 1e-3, 5e-3, 0.02, 0.1, 0.2};
  // An instability becomes visible within two swings.
  constexpr double kSwings = 2;
  constexpr int kDecades = 10, kMaxMapSteps = 25'000;
  std::vector<MapCell> cells;
  for (const auto integrator :
       {scene::Integrator::implicit_euler, scene::Integrator::implicit_midpoint, scene::Integrator::bdf2}) {
    for (int decade = 0; decade <= kDecades; ++decade) {
      for (const double step : kSteps) {
        const double stiffness = std::pow(10.0, decade - 2);
        const scene::Scene scene = swing(integrator, stiffness, step);
        const double duration = std::min(kSwings * swing_period(), kMaxMapSteps * step);
        MapCell cell{integrator, stiffness, step};
        cell.outcome = try_scene(scene, static_cast<int>(std::ceil(duration * scene.time.fps)));
        cell.swings = cell.outcome.frames / scene.time.fps / swing_period();
        cell.stiffest_periods = cell.outcome.frames / scene.time.fps / stiffest_period(stiffness);
        cells.push_back(cell);
        if (each) each(cells.back());
      }
    }
  }
  return cells;
}

}  // namespace weft::bench
