#include "bench/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bench/trajectory.hpp"
#include "core/error.hpp"
#include "simulation/collision_stage.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

// Fixed steps: from four times the scene's on, each half of the one before.
constexpr int kSteps = 6;
constexpr double kCoarsest = 4;
// How much finer the steps of the reference are than the finest measured: its error is then below a sixtieth of theirs.
// With contact its error is that of diverging paths rather than that of its steps.
constexpr int kReferenceCut = 8, kReferenceCutWithContact = 2;
// Tolerances of positions [m], half a decade apart, until steps are shorter than the fixed ones.
constexpr double kLargestTolerance = 1e-3;
constexpr int kTolerances = 9, kTolerancesWithContact = 5;
// Solver settings with which the step alone decides; contacts that switch on and off keep Newton's method from more.
constexpr double kExactNewton = 1e-6, kExactNewtonWithContact = 0.1, kExactLinear = 1e-3, kExactLinearWithContact = 0.1;
constexpr double kNewtonTolerances[] = {1, 0.3, 0.1, 0.03, 0.01, 0.003};
constexpr double kLinearTolerances[] = {0.3, 0.1, 0.03, 0.01, 0.003};
constexpr double kNewtonOfLinear = 0.01;  // where the linear tolerance is varied
constexpr double kRefinements[] = {2, 1, 0.5, 0.25};
// Displacements of the start that should not matter [m].
constexpr double kPerturbations[] = {1e-6, 2e-6};
// Runs shorter than this [s] are timed twice.
constexpr double kShortRun = 0.3;
// A run that halves its steps over and over is stopped after so many times the steps it should take, or those of the
// finest one where these are more.
constexpr int kStepLimit = 3;

// As `measure_accuracy` does it, step by step.
class Campaign {
 public:
  Campaign(const scene::Scene& scene, const EachRun& each);
  Accuracy measure();

 private:
  // Settings of one series, from coarse to fine, and what its runs are held against.
  struct Series {
    Axis axis;
    Integrator integrator;
    std::vector<Setting> settings;
    std::shared_ptr<const Trajectory> against;
    std::string no_against = {};  // why there is nothing to hold against
    std::vector<Run> runs = {};
    bool ended = false;
  };

  scene::Scene with(const Setting& setting) const;
  Setting exact(Integrator integrator, double step) const;
  Setting as_in_scene(Integrator integrator, double step) const;
  int steps_of(double step) const {
    return result_.frames * static_cast<int>(std::lround(1 / (scene_.time.fps * step)));
  }
  double work_of(const Setting& setting) const;

  void measure_reference();
  void measure_meshes();
  void add_series();
  void run_next_of(Series& series, std::size_t k);
  Run run(Axis axis, const Setting& setting, const Trajectory* against, const std::vector<std::size_t>& same = {},
          std::shared_ptr<Trajectory>* keep = nullptr);
  void told(const Run& run);

  const scene::Scene& scene_;
  const EachRun& each_;
  Accuracy result_;
  double finest_ = 0, scene_step_ = 0;  // steps [s]
  Integrator best_;                     // of second order, and works here
  std::shared_ptr<Trajectory> reference_;
  std::vector<Series> series_;
  double work_ = 0, work_done_ = 0;  // [particle steps]
};

Campaign::Campaign(const scene::Scene& scene, const EachRun& each) : scene_(scene), each_(each) {
  result_.contact = simulation::CollisionStage::needed(scene);
  result_.frames = scene.frame_count() - 1;
  result_.duration = result_.frames / scene.time.fps;
  best_ = result_.contact ? Integrator::bdf2 : Integrator::implicit_midpoint;
  // Frames are cut into equal steps, so that the steps asked for are the steps taken.
  const double coarsest = std::max(1.0, std::round(1 / (scene.time.fps * kCoarsest * scene.time.step)));
  scene_step_ = 1 / (scene.time.fps * coarsest * kCoarsest);
  finest_ = 1 / (scene.time.fps * coarsest * std::pow(2.0, kSteps - 1));
}

scene::Scene Campaign::with(const Setting& setting) const {
  scene::Scene scene = scene_;
  scene.time.integrator = setting.integrator;
  scene.time.step = setting.step;
  scene.time.tolerance = setting.tolerance;
  scene.solver.newton_tolerance = setting.newton_tolerance;
  scene.solver.linear_tolerance = setting.linear_tolerance;
  if (setting.refinement != 1) refine(scene, setting.refinement);
  for (scene::Cloth& cloth : scene.cloths) cloth.start_noise += setting.noise;
  return scene;
}

Setting Campaign::exact(Integrator integrator, double step) const {
  return {.integrator = integrator,
          .step = step,
          .newton_tolerance = result_.contact ? kExactNewtonWithContact : kExactNewton,
          .linear_tolerance = result_.contact ? kExactLinearWithContact : kExactLinear};
}

Setting Campaign::as_in_scene(Integrator integrator, double step) const {
  return {.integrator = integrator,
          .step = step,
          .newton_tolerance = scene_.solver.newton_tolerance,
          .linear_tolerance = scene_.solver.linear_tolerance};
}

// Steps it is going to take, times how many more particles than the scene's. Steps with a tolerance t go as t^(1/2)
// with Euler and as t^(1/3) with the others; t = 1e-3 m asks for about the coarsest.
double Campaign::work_of(const Setting& setting) const {
  const double root = setting.integrator == Integrator::implicit_euler ? 2 : 3;
  const double step = setting.tolerance
                          ? kCoarsest * scene_step_ * std::pow(*setting.tolerance / kLargestTolerance, 1 / root)
                          : setting.step;
  return result_.frames / (scene_.time.fps * step) * setting.refinement * setting.refinement;
}

void Campaign::told(const Run& run) {
  work_done_ += work_of(run.setting);
  if (each_) each_(run, std::min(1.0, work_done_ / work_));
}

Run Campaign::run(Axis axis, const Setting& setting, const Trajectory* against, const std::vector<std::size_t>& same,
                  std::shared_ptr<Trajectory>* keep) {
  Run run{.axis = axis, .setting = setting};
  const int limit = kStepLimit * std::max(steps_of(finest_), setting.tolerance ? 0 : steps_of(setting.step));
  try {
    const scene::Scene scene = with(setting);
    auto trajectory = std::make_shared<Trajectory>(follow(scene, limit, run));
    if (run.cpu_s < kShortRun) {
      Run again;
      follow(scene, limit, again);
      run.cpu_s = std::min(run.cpu_s, again.cpu_s);
    }
    if (against) run.errors = compare(*trajectory, *against, same);
    if (keep) *keep = std::move(trajectory);
  } catch (const Error& error) {
    run.failure = error.what();
  }
  told(run);
  return run;
}

void Campaign::measure_reference() {
  std::string failure;
  for (int cut = result_.contact ? kReferenceCutWithContact : kReferenceCut; cut >= 1 && !reference_; cut /= 2) {
    result_.reference = exact(best_, finest_ / cut);
    failure = run(Axis::step, result_.reference, nullptr, {}, &reference_).failure;
  }
  if (!reference_) throw Error(ExitCode::simulation_failed, "the reference run failed: {}", failure);
  result_.largest_energy = reference_->energies_in_play;
  std::vector<Run> doubts{run(Axis::step, exact(best_, 2 * result_.reference.step), reference_.get())};
  if (result_.contact) {
    std::shared_ptr<Trajectory> unperturbed;
    const Setting finest = exact(best_, finest_);
    run(Axis::step, finest, nullptr, {}, &unperturbed);
    for (double noise : kPerturbations) {
      Setting perturbed = finest;
      perturbed.noise = noise;
      if (unperturbed) doubts.push_back(run(Axis::step, perturbed, unperturbed.get()));
    }
  }
  if (doubts.front().failed()) result_.uncertainty.fill(std::numeric_limits<double>::infinity());
  for (const Run& doubt : doubts) {
    for (std::size_t q = 0; q < kQuantities; ++q)
      result_.uncertainty[q] = std::max(result_.uncertainty[q], doubt.errors[q]);
  }
}

// From fine to coarse, each held against the one before; listed from coarse to fine.
void Campaign::measure_meshes() {
  std::shared_ptr<Trajectory> finer;
  for (double refinement : kRefinements) {
    if (!can_refine(scene_, refinement)) continue;
    Setting setting = exact(best_, 0.5 * scene_step_);
    setting.refinement = refinement;
    const std::shared_ptr<Trajectory> against = std::move(finer);
    finer.reset();
    Run result = run(Axis::mesh, setting, against.get(),
                     against ? same_in_twice_as_fine(with(setting)) : std::vector<std::size_t>{}, &finer);
    if (!against && refinement < kRefinements[0] && !result.failed()) result.failure = "nothing finer to compare with";
    result_.runs.insert(result_.runs.begin(), std::move(result));
  }
}

void Campaign::add_series() {
  for (Integrator integrator : kIntegrators) {
    Series step{Axis::step, integrator, {}, reference_}, scene_step{Axis::scene_step, integrator, {}, reference_},
        tolerance{Axis::tolerance, integrator, {}, reference_};
    for (int k = 0; k < kSteps; ++k) {
      const double h = finest_ * std::pow(2.0, kSteps - 1 - k);
      step.settings.push_back(exact(integrator, h));
      scene_step.settings.push_back(as_in_scene(integrator, h));
    }
    for (int k = 0; k < (result_.contact ? kTolerancesWithContact : kTolerances); ++k) {
      tolerance.settings.push_back(as_in_scene(integrator, scene_step_));
      tolerance.settings.back().tolerance = kLargestTolerance * std::pow(10.0, -0.5 * k);
    }
    for (Series* series : {&step, &scene_step, &tolerance}) series_.push_back(std::move(*series));
  }
  // What the solver leaves: with the scene's integrator, and with the other one that works everywhere.
  const Integrator others[] = {scene_.time.integrator, Integrator::bdf2};
  for (std::size_t i = 0; i < (others[0] == others[1] ? 1u : 2u); ++i) {
    std::shared_ptr<Trajectory> solved;
    const Run exactly = run(Axis::step, exact(others[i], scene_step_), nullptr, {}, &solved);
    Series newton{Axis::newton, others[i], {}, solved, exactly.failure},
        linear{Axis::linear, others[i], {}, solved, exactly.failure};
    for (double tolerance : kNewtonTolerances) {
      newton.settings.push_back(as_in_scene(others[i], scene_step_));
      newton.settings.back().newton_tolerance = tolerance;
    }
    for (double tolerance : kLinearTolerances) {
      linear.settings.push_back(as_in_scene(others[i], scene_step_));
      linear.settings.back().newton_tolerance = kNewtonOfLinear;
      linear.settings.back().linear_tolerance = tolerance;
    }
    series_.push_back(std::move(newton));
    series_.push_back(std::move(linear));
  }
}

void Campaign::run_next_of(Series& series, std::size_t k) {
  const Setting& setting = series.settings[k];
  if (!series.against) {
    series.runs.push_back({.axis = series.axis, .setting = setting, .failure = series.no_against});
    return told(series.runs.back());
  }
  series.runs.push_back(run(series.axis, setting, series.against.get()));
  const Run& last = series.runs.back();
  series.ended = series.axis == Axis::tolerance && (last.failed() || last.steps > steps_of(finest_));
}

Accuracy Campaign::measure() {
  // Known before, but for the series' ends.
  const double unit = work_of(exact(best_, scene_step_));
  work_ = unit * (result_.contact ? 200 : 400);
  measure_reference();
  measure_meshes();
  add_series();
  work_ = work_done_;
  for (const Series& series : series_)
    for (const Setting& setting : series.settings) work_ += work_of(setting);
  // Taking turns, so that a machine that gets slower or faster favours none.
  for (std::size_t k = 0; k < kTolerances; ++k) {
    for (Series& series : series_)
      if (k < series.settings.size() && !series.ended) run_next_of(series, k);
  }
  for (Series& series : series_)
    result_.runs.insert(result_.runs.end(), std::make_move_iterator(series.runs.begin()),
                        std::make_move_iterator(series.runs.end()));
  return std::move(result_);
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  constexpr std::string_view kNames[kQuantities] = {"position", "velocity",    "energy",        "shadow",
                                                    "top",      "rest energy", "centre of mass"};
  return kNames[static_cast<std::size_t>(quantity)];
}

std::string_view unit_of(Quantity quantity) {
  constexpr std::string_view kUnits[kQuantities] = {"m", "m/s", "1", "1", "m", "1", "m"};
  return kUnits[static_cast<std::size_t>(quantity)];
}

double control_of(const Run& run) {
  switch (run.axis) {
    case Axis::step:
    case Axis::scene_step:
      return run.setting.step;
    case Axis::tolerance:
      return run.setting.tolerance.value_or(0);
    case Axis::newton:
      return run.setting.newton_tolerance;
    case Axis::linear:
      return run.setting.linear_tolerance;
    case Axis::mesh:
      return 1 / run.setting.refinement;
  }
  return 0;
}

double expected_order(const Run& run) {
  const double order = run.setting.integrator == Integrator::implicit_euler ? 1 : 2;
  switch (run.axis) {
    case Axis::step:
    case Axis::scene_step:
      return order;
    case Axis::tolerance:
      return order / (order + 1);
    case Axis::newton:
    case Axis::mesh:
      return 1;
    case Axis::linear:
      return 0;
  }
  return 0;
}

Quantity deciding_quantity(const Accuracy& accuracy) {
  return accuracy.uncertainty[static_cast<std::size_t>(Quantity::position)] < 1e-4 ? Quantity::position
                                                                                   : Quantity::centre;
}

std::vector<const Run*> Accuracy::series(Axis axis, Integrator integrator) const {
  std::vector<const Run*> found;
  for (const Run& run : runs)
    if (run.axis == axis && run.setting.integrator == integrator) found.push_back(&run);
  return found;
}

Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each) {
  return Campaign(scene, each).measure();
}

}  // namespace weft::bench
