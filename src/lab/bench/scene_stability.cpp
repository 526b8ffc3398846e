#include "lab/bench/scene_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/run_error/trajectory.hpp"
#include "film/scene/ropes.hpp"

namespace weft::bench {
namespace {

// A trial is aborted if its CPU time exceeds kSlowRatio times that of the unchanged scene, plus kSlowSeconds [s].
constexpr double kSlowRatio = 20, kSlowSeconds = 5;

constexpr std::size_t index_of(VariedParameter axis) {
  return static_cast<std::size_t>(axis);
}

// All friction coefficients of a scene.
std::vector<double*> frictions(scene::Scene& scene) {
  std::vector<double*> all;
  for (scene::Cloth& cloth : scene.cloths) all.push_back(&cloth.material.friction);
  for (scene::Obstacle& obstacle : scene.obstacles) all.push_back(&obstacle.friction);
  for (scene::Character& character : scene.characters) {
    all.push_back(&character.friction);
    for (scene::BodyPart& part : character.parts)
      if (part.friction) all.push_back(&*part.friction);
  }
  for (scene::FrictionPair& pair : scene.contact.pairs) {
    all.push_back(&pair.friction);
    if (pair.static_friction) all.push_back(&*pair.static_friction);
  }
  return all;
}

// A rope with other values. Its damping is relative to its stiffness, so that a factor on the stiffness leaves the
// viscosities as they are.
std::shared_ptr<const scene::Rope> scale_rope(const scene::Rope& rope, double stiffness, double mass, double damping) {
  const scene::RopeNumbers numbers = scene::numbers_of(rope);
  auto scaled = std::make_shared<scene::Rope>(rope);
  scaled->stretch = stiffness * numbers.stretch;
  scaled->bend = stiffness * numbers.bend;
  scaled->mass = mass * numbers.mass;
  scaled->damping *= damping / stiffness;
  scaled->drag *= damping;
  return scaled;
}

void scale_materials(scene::Scene& scene, const Factors& factors) {
  const double stiffness = factors[index_of(VariedParameter::stiffness)],
               mass = factors[index_of(VariedParameter::mass)], friction = factors[index_of(VariedParameter::friction)],
               damping = factors[index_of(VariedParameter::damping)];
  for (scene::Cloth& cloth : scene.cloths) {
    scene::Material& material = cloth.material;
    for (double* value : {&material.stretch_weft, &material.stretch_warp, &material.shear, &material.bend})
      *value *= stiffness;
    for (double* value : {&material.stretch_viscosity, &material.shear_viscosity, &material.bend_viscosity,
                          &material.bend_friction, &material.drag})
      *value *= damping;
    material.density *= mass;
    for (scene::Weight& weight : cloth.weights) weight.mass *= mass;
    if (cloth.rope) cloth.rope = scale_rope(*cloth.rope, stiffness, mass, damping);
  }
  for (double* value : frictions(scene)) *value *= friction;
}

// Multiplies the number of cells along each side by `factor`. Returns false if this is not possible.
bool scale_mesh(scene::Scene& scene, double factor) {
  if (factor == 1) return true;
  const bool all_patterns = std::ranges::all_of(
      scene.cloths, [](const scene::Cloth& cloth) { return cloth.shape == scene::ClothShape::pattern; });
  if (!all_patterns && !run_error::can_refine(scene, factor)) return false;
  run_error::refine(scene, factor);
  for (scene::Cloth& cloth : scene.cloths) cloth.edge_length /= factor;
  return true;
}

// Whether the factor changes the simulation. For example, if all values of this parameter are 0, no factor changes it.
bool changes(const scene::Scene& scene, VariedParameter axis, double factor) {
  scene::Scene varied = scene;
  Factors factors{1, 1, 1, 1, 1, 1};
  factors[index_of(axis)] = factor;
  scale_materials(varied, factors);
  const auto same = [&](auto... members) {
    for (std::size_t c = 0; c < scene.cloths.size(); ++c)
      if (((scene.cloths[c].material.*members != varied.cloths[c].material.*members) || ...)) return false;
    return true;
  };
  using scene::Material;
  switch (axis) {
    case VariedParameter::stiffness:
      return !scene.ropes.empty() ||
             !same(&Material::stretch_weft, &Material::stretch_warp, &Material::shear, &Material::bend);
    case VariedParameter::mass:
      return !scene.cloths.empty();
    case VariedParameter::damping:
      return std::ranges::any_of(scene.ropes, [](const scene::Rope& rope) { return rope.damping > 0; }) ||
             !same(&Material::stretch_viscosity, &Material::shear_viscosity, &Material::bend_viscosity,
                   &Material::bend_friction, &Material::drag);
    case VariedParameter::friction:
      varied = scene;  // a factor of 0 has set all coefficients of `varied` to 0
      return std::ranges::any_of(frictions(varied), [](const double* value) { return *value != 0; }) &&
             (scene.contact.self || scene.contact.obstacles);
    // The simulation takes no step longer than a frame. Each factor above 1 is twice the factor before it. If half of a
    // factor already gives a step of at least a frame, the factor gives the same simulation as its half.
    case VariedParameter::step:
      return scene.time.tolerance || scene.time.step * (factor > 1 ? 0.5 * factor : factor) < 1 / scene.time.fps;
    case VariedParameter::mesh:
      return true;
  }
  return true;
}

// Adds the faults of a frame (see TrialVerdict) to `faults`.
void add_faults(const simulation::FrameReport& report, std::set<std::string>& faults) {
  if (report.min_distance <= 0 && report.frame > 0) faults.insert("surfaces touch or pass through each other");
  if (report.stretch_ratio > simulation::kMaxStretchRatio) faults.insert("cloth is stretched beyond its max_stretch");
  if (report.pinched_pairs > 0) faults.insert("cloth is caught in an obstacle");
  if (report.lagging_particles > 0) faults.insert("a pin is held back");
  for (const std::string& warning : report.warnings) {
    if (warning.find("more than at the start") != std::string::npos) faults.insert("energy comes from nowhere");
    if (warning.find("the solver has left forces") != std::string::npos)
      faults.insert("the solver leaves the motion unsolved");
  }
}

bool is_finite(const production::SceneSimulation& simulation) {
  return std::ranges::all_of(simulation.state().positions, [](const Vec3& x) { return x.allFinite(); });
}

// Runs the scene until it ends, fails, becomes too slow, or `stop` interrupts it. Records the results in `trial`.
void run(const scene::Scene& scene, double max_cpu_s, const std::function<bool()>& stop, Trial& trial) {
  const double begin = process_cpu_seconds();
  std::set<std::string> faults;
  const auto note = [&](const simulation::FrameReport& report) {
    trial.steps += report.steps;
    trial.rejected_steps += report.rejected_steps;
    trial.newton_iterations += report.newton_iterations;
    trial.max_strain = std::max(trial.max_strain, report.max_strain);
    add_faults(report, faults);
    trial.new_faults.assign(faults.begin(), faults.end());
  };
  const auto may_continue = [&] {
    if (stop()) throw Error(ExitCode::interrupted, "interrupted");
    return process_cpu_seconds() - begin < max_cpu_s;
  };
  production::SceneSimulation simulation(scene);
  bool in_time = simulation.run_preroll(may_continue);
  for (int k = 1; k < scene.frame_count() && in_time; ++k) {
    note(simulation.advance());
    ++trial.frames;
    if (!is_finite(simulation)) {
      trial.verdict = TrialVerdict::not_finite;
      return;
    }
    in_time = k + 1 == scene.frame_count() || may_continue();
  }
  if (!in_time) trial.verdict = TrialVerdict::too_slow;
}

// Runs a trial. `known`: faults that are not new; see TrialVerdict.
Trial try_factors(const scene::Scene& scene, const Factors& factors, double max_cpu_s,
                  const std::vector<std::string>& known, const std::function<bool()>& stop) {
  Trial trial{factors};
  scene::Scene varied = scene;
  scale_materials(varied, factors);
  const double step = factors[index_of(VariedParameter::step)];
  varied.time.step *= step;
  if (varied.time.tolerance) *varied.time.tolerance *= step;
  trial.step = varied.time.tolerance ? 0 : std::min(varied.time.step, 1 / varied.time.fps);
  if (!scale_mesh(varied, factors[index_of(VariedParameter::mesh)])) {
    trial.verdict = TrialVerdict::impossible;
    trial.reason = "the cells cannot be cut so";
    return trial;
  }
  const double begin = process_cpu_seconds();
  try {
    run(varied, max_cpu_s, stop, trial);
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
    trial.verdict = error.code() == ExitCode::simulation_failed ? TrialVerdict::refused : TrialVerdict::impossible;
    trial.reason = error.what();
  }
  trial.cpu_s = process_cpu_seconds() - begin;
  // Up to here, `new_faults` also contains the known faults.
  trial.is_free_of_faults = trial.verdict == TrialVerdict::holds && trial.new_faults.empty();
  std::erase_if(trial.new_faults, [&](const std::string& what) { return std::ranges::count(known, what) > 0; });
  if (trial.verdict == TrialVerdict::holds && !trial.new_faults.empty()) trial.verdict = TrialVerdict::warned;
  return trial;
}

// The factors of all trials: first those that vary a single parameter, then those of the map.
std::vector<Factors> plan_trials(const scene::Scene& scene) {
  std::vector<Factors> plan;
  const auto add = [&](const Factors& factors) {
    if (factors != Factors{1, 1, 1, 1, 1, 1} && std::ranges::count(plan, factors) == 0) plan.push_back(factors);
  };
  for (std::size_t a = 0; a < kVariedValues; ++a)
    for (const double factor : factors_of(static_cast<VariedParameter>(a))) {
      Factors factors{1, 1, 1, 1, 1, 1};
      factors[a] = factor;
      if (changes(scene, static_cast<VariedParameter>(a), factor)) add(factors);
    }
  for (const double stiffness : kMapStiffness)
    for (const double step : kMapSteps)
      if (changes(scene, VariedParameter::step, step) && changes(scene, VariedParameter::stiffness, stiffness))
        add({stiffness, step, 1, 1, 1, 1});
  return plan;
}

}  // namespace

std::string_view name_of(VariedParameter axis) {
  constexpr std::string_view kNames[kVariedValues] = {"stiffness", "step", "mass", "friction", "damping", "mesh"};
  return kNames[index_of(axis)];
}

std::string_view describe(TrialVerdict verdict) {
  constexpr std::string_view kNames[kTrialVerdicts] = {"holds",      "warned of", "refused",
                                                       "not finite", "too slow",  "impossible"};
  return kNames[static_cast<std::size_t>(verdict)];
}

const std::vector<double>& factors_of(VariedParameter axis) {
  static const std::vector<double> kDecades{1e-3, 1e-2, 0.1, 1, 10, 100, 1e3};
  static const std::array<std::vector<double>, kVariedValues> kFactors{
      {kDecades, {0.125, 0.25, 0.5, 1, 2, 4, 8}, kDecades, {0, 0.25, 0.5, 1, 2, 4, 8}, kDecades, {0.25, 0.5, 1, 2}}};
  return kFactors[index_of(axis)];
}

const Trial* SceneStability::find(const Factors& factors) const {
  if (factors == as_is.factors) return &as_is;
  const auto found = std::ranges::find(trials, factors, &Trial::factors);
  return found == trials.end() ? nullptr : &*found;
}

SceneStability measure_scene_stability(const scene::Scene& scene,
                                       const std::function<void(const Trial&, double done)>& each,
                                       const std::function<bool()>& stop) {
  SceneStability result;
  result.frames = scene.frame_count() - 1;
  const std::vector<Factors> plan = plan_trials(scene);
  const auto report_trial = [&](const Trial& trial) {
    if (each) each(trial, static_cast<double>(result.trials.size() + 1) / static_cast<double>(plan.size() + 1));
  };
  // If the scene cannot be built, throw its error.
  { const production::SceneSimulation whole(scene); }
  result.as_is = try_factors(scene, {1, 1, 1, 1, 1, 1}, std::numeric_limits<double>::infinity(), {}, stop);
  report_trial(result.as_is);
  const double max_cpu_s = kSlowRatio * result.as_is.cpu_s + kSlowSeconds;
  for (const Factors& factors : plan) {
    try {
      result.trials.push_back(try_factors(scene, factors, max_cpu_s, result.as_is.new_faults, stop));
    } catch (const Error& error) {
      if (error.code() != ExitCode::interrupted) throw;
      break;
    }
    report_trial(result.trials.back());
  }
  return result;
}

std::vector<Margin> margins_of(const SceneStability& stability) {
  std::vector<Margin> margins;
  for (std::size_t a = 0; a < kVariedValues; ++a) {
    const auto axis = static_cast<VariedParameter>(a);
    std::vector<double> below, above;
    for (const double factor : factors_of(axis)) {
      if (factor < 1) below.insert(below.begin(), factor);
      if (factor > 1) above.push_back(factor);
    }
    for (const std::vector<double>& side : {below, above}) {
      Margin margin{axis};
      bool any = false;
      for (const double factor : side) {
        Factors factors{1, 1, 1, 1, 1, 1};
        factors[a] = factor;
        const Trial* trial = stability.find(factors);
        if (trial == nullptr || trial->verdict == TrialVerdict::impossible) continue;
        any = true;
        if (trial->breaks()) {
          margin.breaks = trial;
          break;
        }
        margin.holds = factor;
      }
      if (any) margins.push_back(margin);
    }
  }
  return margins;
}

}  // namespace weft::bench
