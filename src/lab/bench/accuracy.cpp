#include "lab/bench/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "film/production/plan.hpp"
#include "film/production/scene_simulation.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

// Fixed steps, relative to the scene's.
constexpr double kSteps[] = {4, 2, 1, 0.5, 0.25, 0.125};
// The step of the references is the shortest measured step divided by this number. Without contact, a second-order
// reference then has 1/64 of the error at the shortest measured step. With contact, a divisor of 8 would not help:
// chaotic divergence exceeds the error of the step.
constexpr int kReferenceStepDivisor = 8, kReferenceStepDivisorWithContact = 2;
// The values of time.tolerance begin at kLargestTolerance [m]; each is 1/√10 of the value before. There are kTolerances
// values (with contact, kTolerancesWithContact); fewer if a run fails or takes more steps than a run with the shortest
// fixed step.
constexpr double kLargestTolerance = 1e-3;
constexpr int kTolerances = 9, kTolerancesWithContact = 5;
// The runs of a step divide newton_tolerance by ten each time, from the scene's value down to this minimum. If the
// scene's value is smaller, all listed runs have the scene's.
constexpr double kMinNewtonTolerance = 1e-8, kDecade = 0.1;
// newton_tolerance of the runs of Axis::mesh, relative to the scene's: their error must be that of the mesh.
constexpr double kMeshNewtonRatio = 1e-2;
// A tenfold newton_tolerance matters little if it changes the result by at most this fraction of the error due to the
// step; see Run::is_step_limited and tighten().
constexpr double kMaxSolverChangeRatio = 0.1;
constexpr double kLinearTolerances[] = {0.3, 0.1, 0.03, 0.01, 0.003};
constexpr double kRefinements[] = {2, 1, 0.5, 0.25};
// Each start has this much more start_noise than the start before [m].
constexpr double kStartShift = 1e-6;
// If there is only one start and its run takes less CPU time than this [s], it is repeated, and the smaller time
// counts.
constexpr double kShortRun = 0.3;
// A run fails if it takes too many steps. Let n be the number of steps with the shortest fixed step. With fixed steps,
// the limit is kMaxStepRatio max(n, expected number); with time.tolerance, it is min(kMaxStepRatio n, number of steps
// of the reference).
constexpr int kMaxStepRatio = 3;

// Runs of one setting from all starts; see Run.
struct Sample {
  bool contact = false;
  std::vector<Trajectory> starts;
  Functionals middle;  // median over the starts
  Errors spread{};     // see Run::spread
  Work work;           // see Run::work
};

// The tolerance multiplied by `ratio`, but at least kMinNewtonTolerance and at most `tolerance`.
double tighter_newton_tolerance(double tolerance, double ratio) {
  return std::min(tolerance, std::max(kMinNewtonTolerance, ratio * tolerance));
}

Errors difference(const Sample& a, const Sample& b, const std::vector<std::size_t>& same = {}) {
  return a.contact ? compare(a.middle, b.middle) : compare(a.starts[0], b.starts[0], same);
}

// Largest difference between a start and the median of all starts or, without contact, the first start (Run::spread).
Errors spread_of(const Sample& sample) {
  Errors spread{};
  for (const Trajectory& start : sample.starts) {
    const Errors apart =
        sample.contact ? compare(start.functionals, sample.middle) : compare(start, sample.starts.front());
    for (std::size_t q = 0; q < kQuantities; ++q) spread[q] = std::max(spread[q], apart[q]);
  }
  return spread;
}

// One call of measure_accuracy().
class AccuracyMeasurement {
 public:
  AccuracyMeasurement(const scene::Scene& scene, const EachRun& each, const AccuracyPlan& plan);
  Accuracy measure();

 private:
  using SamplePtr = std::shared_ptr<const Sample>;

  scene::Scene scene_with(const Setting& setting) const;
  Setting as_in_scene(Integrator integrator, double step) const {
    return {integrator, step, {}, scene_.solver.newton_tolerance, scene_.solver.linear_tolerance};
  }
  // The longest step that divides a frame evenly and is at most `step` [s]; the simulation chooses its steps in the
  // same way.
  double even_step(double step) const {
    return 1 / (scene_.time.fps * std::max(1.0, std::ceil(1 / (scene_.time.fps * step) - 1e-9)));
  }
  int steps_of(double step) const {
    return result_.frames * static_cast<int>(std::lround(1 / (scene_.time.fps * step)));
  }
  // Assumed factor by which the error falls if the step is divided by `shorter`. The exponent is half of the order
  // (with contact, 0.5), because waves and contact lower the observed order; the full order would understate the
  // uncertainty.
  double error_ratio(Integrator integrator, double shorter) const {
    const double order = result_.contact ? 1 : expected_order({.setting = {.integrator = integrator}});
    return std::pow(shorter, 0.5 * order);
  }
  int reference_step_divisor() const {
    return result_.contact ? kReferenceStepDivisorWithContact : kReferenceStepDivisor;
  }
  double work_of(const Setting& setting) const;

  SamplePtr sample(const Setting& setting) const;
  SamplePtr run(Run& run, const SamplePtr& against, const std::vector<std::size_t>& same = {});
  SamplePtr run_or_throw(const Setting& setting);
  Errors tighten(Setting& twice, SamplePtr& coarse);
  SamplePtr measure_candidate(Candidate& candidate);
  void measure_references();
  SamplePtr measure_grid(Integrator integrator, double step);
  void measure_steps(Integrator integrator);
  std::vector<double> tolerances_of(Integrator integrator) const;
  bool is_step_limited(const Run& run, const Run& tighter) const;
  void measure_tolerances(Integrator integrator);
  void measure_linear();
  void measure_meshes();

  const scene::Scene& scene_;
  const EachRun& each_;
  const AccuracyPlan& plan_;
  Accuracy result_;
  std::vector<double> steps_;  // measured fixed steps, descending [s]
  std::vector<Integrator> integrators_;
  double finest_ = 0, scene_step_ = 0;  // shortest measured step; even_step() of the scene's step [s]
  Integrator best_, other_;             // integrators of the two references
  SamplePtr reference_;
  double work_ = 0, work_done_ = 0;  // expected and finished work; see work_of()
};

AccuracyMeasurement::AccuracyMeasurement(const scene::Scene& scene, const EachRun& each, const AccuracyPlan& plan)
    : scene_(scene), each_(each), plan_(plan) {
  result_.contact = production::can_collide(scene);
  result_.starts = plan.starts.value_or(result_.contact ? kMinStartsWithContact : 1);
  if (result_.contact && result_.starts < kMinStartsWithContact)
    throw Error(ExitCode::usage, "--starts: expected at least {}, as surfaces may touch in this scene, got {}",
                kMinStartsWithContact, result_.starts);
  for (const double refinement : plan.meshes.value_or(std::vector<double>{}))
    if (!run_error::can_refine(scene, refinement) || !run_error::can_refine(scene, 2 * refinement))
      throw Error(ExitCode::usage,
                  "--meshes: expected factors that give whole numbers of cells along each side, got {:g}", refinement);
  result_.frames = scene.frame_count() - 1;
  result_.duration = result_.frames / scene.time.fps;
  result_.cloth_size = run_error::cloth_size(*production::SceneSimulation(scene).snapshot());
  best_ = result_.contact ? Integrator::bdf2 : Integrator::implicit_midpoint;
  other_ = result_.contact ? Integrator::implicit_euler : Integrator::bdf2;
  integrators_ = plan.integrators.value_or(std::vector<Integrator>(std::begin(kIntegrators), std::end(kIntegrators)));
  // The simulation takes only steps that divide a frame evenly.
  scene_step_ = even_step(scene.time.step);
  std::set<double, std::greater<>> steps;
  for (const double factor : plan.steps.value_or(std::vector<double>(std::begin(kSteps), std::end(kSteps))))
    steps.insert(even_step(factor * scene_step_));
  steps_.assign(steps.begin(), steps.end());
  finest_ = steps_.empty() ? scene_step_ : steps_.back();
  result_.of_scene = as_in_scene(scene.time.integrator, scene_step_);
  result_.of_scene.tolerance = scene.time.tolerance;
}

scene::Scene AccuracyMeasurement::scene_with(const Setting& setting) const {
  scene::Scene scene = scene_;
  scene.time.integrator = setting.integrator;
  scene.time.step = setting.step;
  scene.time.tolerance = setting.tolerance;
  scene.solver.newton_tolerance = setting.newton_tolerance;
  scene.solver.linear_tolerance = setting.linear_tolerance;
  if (setting.refinement != 1) run_error::refine(scene, setting.refinement);
  return scene;
}

// Expected number of steps, times the number of particles relative to the scene. If the setting has a tolerance t, the
// assumed step is kSteps[0] times the scene's at t = kLargestTolerance, and proportional to t^(1/2) for Euler and to
// t^(1/3) for the others.
double AccuracyMeasurement::work_of(const Setting& setting) const {
  const double root = setting.integrator == Integrator::implicit_euler ? 2 : 3;
  const double step = setting.tolerance
                          ? kSteps[0] * scene_step_ * std::pow(*setting.tolerance / kLargestTolerance, 1 / root)
                          : setting.step;
  return result_.frames / (scene_.time.fps * step) * setting.refinement * setting.refinement;
}

// Runs a setting from all starts. Throws if one of the runs fails.
AccuracyMeasurement::SamplePtr AccuracyMeasurement::sample(const Setting& setting) const {
  const run_error::FollowLimits limits{
      .steps = setting.tolerance ? std::min(kMaxStepRatio, reference_step_divisor()) * steps_of(finest_)
                                 : kMaxStepRatio * std::max(steps_of(finest_), steps_of(setting.step))};
  auto sample = std::make_shared<Sample>();
  sample->contact = result_.contact;
  std::vector<Functionals> functionals;
  scene::Scene scene = scene_with(setting);
  for (int start = 0; start < result_.starts; ++start) {
    sample->starts.push_back(run_error::follow(scene, limits));
    functionals.push_back(sample->starts.back().functionals);
    for (scene::Cloth& cloth : scene.cloths) cloth.start_noise += kStartShift;
  }
  sample->middle = median(functionals);
  sample->work = sample->starts[0].work;
  sample->spread = spread_of(*sample);
  for (const Trajectory& start : sample->starts) sample->work.cpu_s = std::min(sample->work.cpu_s, start.work.cpu_s);
  if (result_.starts == 1 && sample->work.cpu_s < kShortRun)
    sample->work.cpu_s = std::min(sample->work.cpu_s, run_error::follow(scene, limits).work.cpu_s);
  return sample;
}

// Runs the setting of `run`, and stores its cost and its errors against `against` in `run`. If the run fails, stores
// the reason in `run` and returns nullptr.
AccuracyMeasurement::SamplePtr AccuracyMeasurement::run(Run& run, const SamplePtr& against,
                                                        const std::vector<std::size_t>& same) {
  SamplePtr made;
  try {
    made = sample(run.setting);
    run.spread = made->spread;
    run.work = made->work;
    run.particles = static_cast<int>(made->starts[0].masses.size());
    if (against) run.errors = difference(*made, *against, same);
    for (std::size_t k = 0; against && same.empty() && k < made->starts.size(); ++k)
      run.start_errors.push_back(at(result_.contact ? compare(made->starts[k].functionals, against->middle)
                                                    : compare(made->starts[k], against->starts[0]),
                                    deciding_quantity(result_)));
  } catch (const Error& error) {
    run.failure = error.what();
  }
  work_done_ += work_of(run.setting);
  if (each_) each_(run, std::min(1.0, work_done_ / work_));
  return made;
}

// Runs a setting of a reference. Throws if the run fails.
AccuracyMeasurement::SamplePtr AccuracyMeasurement::run_or_throw(const Setting& setting) {
  Run tried{.setting = setting};
  SamplePtr sample = run(tried, nullptr);
  if (!sample) throw Error(ExitCode::simulation_failed, "{}", tried.failure);
  return sample;
}

// `twice`: the setting of a reference with twice its step. Divides its newton_tolerance by ten
// until the result hardly changes: by at most the spread over the starts, or by at most a tenth of
// the change expected from halving the step. Also stops at kMinNewtonTolerance, or if a run fails.
// `coarse`: run of `twice`; replaced by the last successful run. Returns the last change. Throws if
// the run after the first division fails, or if a run with twice the step of `twice` fails. If the newton_tolerance is
// at kMinNewtonTolerance already, returns the change from ten times its value.
Errors AccuracyMeasurement::tighten(Setting& twice, SamplePtr& coarse) {
  const Quantity quantity = deciding_quantity(result_);
  const double order = expected_order({.setting = twice});
  if (twice.newton_tolerance <= kMinNewtonTolerance) {
    Setting looser = twice;
    looser.newton_tolerance /= kDecade;
    return difference(*run_or_throw(looser), *coarse);
  }
  for (Errors change{};;) {
    Run tighter{.setting = twice};
    tighter.setting.newton_tolerance = tighter_newton_tolerance(twice.newton_tolerance, kDecade);
    const SamplePtr sample = run(tighter, coarse);
    // A failed run is accepted only after an earlier division has given a change to return.
    if (!sample && at(change, quantity) == 0) throw Error(ExitCode::simulation_failed, "{}", tighter.failure);
    if (!sample) return change;
    change = tighter.errors;
    twice = tighter.setting;
    coarse = sample;
    Setting four_times = twice;
    four_times.step *= 2;
    const double step = at(difference(*coarse, *run_or_throw(four_times)), quantity) / std::pow(2, order);
    const bool exact = at(change, quantity) <= std::max(kMaxSolverChangeRatio * step, at(sample->spread, quantity));
    if (exact || twice.newton_tolerance <= kMinNewtonTolerance) return change;
  }
}

// Runs a candidate for the reference and estimates its errors. Chooses newton_tolerance at twice
// the step, because such runs take about half the time. If a run fails, stores the reason in
// `candidate` and returns nullptr.
AccuracyMeasurement::SamplePtr AccuracyMeasurement::measure_candidate(Candidate& candidate) {
  try {
    Setting twice = candidate.setting;
    twice.step *= 2;
    SamplePtr coarse = run_or_throw(twice);
    candidate.solver = tighten(twice, coarse);
    candidate.setting.newton_tolerance = twice.newton_tolerance;
    SamplePtr fine = run_or_throw(candidate.setting);
    candidate.step = difference(*coarse, *fine);
    for (double& error : candidate.step) error /= error_ratio(candidate.setting.integrator, 2) - 1;
    candidate.spread = fine->spread;
    candidate.energies_in_play = fine->middle.energies_in_play;
    return fine;
  } catch (const Error& error) {
    candidate.failure = error.what();
    return nullptr;
  }
}

void AccuracyMeasurement::measure_references() {
  const double step = finest_ / reference_step_divisor();
  Candidate first{as_in_scene(best_, step)}, second{as_in_scene(other_, step)};
  reference_ = measure_candidate(first);
  SamplePtr second_sample = measure_candidate(second);
  if (!reference_ && !second_sample)
    throw Error(ExitCode::simulation_failed, "the reference run failed: {}", first.failure);
  const Quantity quantity = deciding_quantity(result_);
  if (!reference_ || (second_sample && at(second.uncertainty(), quantity) < at(first.uncertainty(), quantity))) {
    std::swap(first, second);
    std::swap(reference_, second_sample);
  }
  result_.uncertainty = first.uncertainty();
  if (second_sample) {
    result_.difference = difference(*reference_, *second_sample);
    const Errors explained = second.uncertainty();
    for (std::size_t q = 0; q < kQuantities; ++q)
      result_.uncertainty[q] = std::max(result_.uncertainty[q], result_.difference[q] - explained[q]);
  }
  result_.largest_energy = first.energies_in_play;
  result_.reference = std::move(first);
  result_.second = std::move(second);
}

bool AccuracyMeasurement::is_step_limited(const Run& run, const Run& tighter) const {
  const Quantity q = deciding_quantity(result_);
  return run.change <= std::max(kMaxSolverChangeRatio * error_of(tighter, q), result_.uncertainty_of(tighter, q));
}

// Runs one fixed step. Divides newton_tolerance by ten for each run, from the scene's value until Run::is_step_limited,
// but not below kMinNewtonTolerance. Stops if a run fails. If the scene's value is at kMinNewtonTolerance already, a
// looser run, which is not listed, shows whether the step determines the error. Returns the run with is_step_limited;
// nullptr if there is none.
AccuracyMeasurement::SamplePtr AccuracyMeasurement::measure_grid(Integrator integrator, double step) {
  std::vector<Run> runs;
  std::vector<SamplePtr> samples;
  const Quantity q = deciding_quantity(result_);
  Setting setting = as_in_scene(integrator, step);
  while (true) {
    runs.push_back({.axis = Axis::grid, .setting = setting});
    samples.push_back(run(runs.back(), reference_));
    if (!samples.back()) break;
    if (runs.size() == 1 && setting.newton_tolerance <= kMinNewtonTolerance) {
      Run looser{.axis = Axis::grid, .setting = setting};
      looser.setting.newton_tolerance /= kDecade;
      if (const SamplePtr sample = run(looser, reference_)) {
        looser.change = at(difference(*sample, *samples.back()), q);
        runs.back().is_step_limited = is_step_limited(looser, runs.back());
      }
    }
    if (runs.size() > 1) {
      Run& before = runs[runs.size() - 2];
      before.change = at(difference(*samples[runs.size() - 2], *samples.back()), q);
      before.is_step_limited = is_step_limited(before, runs.back());
      if (before.is_step_limited) break;
    }
    if (setting.newton_tolerance <= kMinNewtonTolerance) break;
    setting.newton_tolerance = tighter_newton_tolerance(setting.newton_tolerance, kDecade);
  }
  const auto tightest = std::find_if(samples.rbegin(), samples.rend(), [](const SamplePtr& s) { return s != nullptr; });
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (samples[k] && samples[k] != *tightest) runs[k].solver_error = at(difference(*samples[k], **tightest), q);
  const auto found = std::ranges::find_if(runs, &Run::is_step_limited);
  SamplePtr exact = found == runs.end() ? nullptr : samples[static_cast<std::size_t>(found - runs.begin())];
  result_.runs.insert(result_.runs.end(), std::make_move_iterator(runs.begin()), std::make_move_iterator(runs.end()));
  return exact;
}

// Measures all fixed steps. Then adds the CrossCheck of the run with the shortest step, if the conditions of CrossCheck
// hold.
void AccuracyMeasurement::measure_steps(Integrator integrator) {
  SamplePtr before, last;
  double step_before = 0, step_last = 0;
  for (const double step : steps_) {
    SamplePtr exact = measure_grid(integrator, step);
    if (!exact) continue;
    before = std::exchange(last, std::move(exact));
    step_before = std::exchange(step_last, step);
  }
  if (!before || step_last > finest_) return;
  CrossCheck check{.integrator = integrator, .step = step_last};
  check.difference = difference(*last, *reference_);
  const Errors change = difference(*before, *last);
  const double ratio = error_ratio(integrator, step_before / step_last);
  for (std::size_t q = 0; q < kQuantities; ++q) check.uncertainty[q] = change[q] / (ratio - 1) + last->spread[q];
  result_.cross_checks.push_back(check);
}

// Values of time.tolerance: those of the plan, or else values half a decade apart. For the scene's integrator, also the
// scene's own tolerance.
std::vector<double> AccuracyMeasurement::tolerances_of(Integrator integrator) const {
  std::set<double, std::greater<>> tolerances;
  for (int k = 0; !plan_.tolerances && k < (result_.contact ? kTolerancesWithContact : kTolerances); ++k)
    tolerances.insert(kLargestTolerance * std::pow(10.0, -0.5 * k));
  if (plan_.tolerances) tolerances.insert(plan_.tolerances->begin(), plan_.tolerances->end());
  if (scene_.time.tolerance && integrator == scene_.time.integrator) tolerances.insert(*scene_.time.tolerance);
  return {tolerances.begin(), tolerances.end()};
}

void AccuracyMeasurement::measure_tolerances(Integrator integrator) {
  for (const double tolerance : tolerances_of(integrator)) {
    Run tried{.axis = Axis::tolerance, .setting = as_in_scene(integrator, scene_step_)};
    tried.setting.tolerance = tolerance;
    run(tried, reference_);
    result_.runs.push_back(std::move(tried));
    const Run& last = result_.runs.back();
    if (!plan_.tolerances && (last.failed() || last.work.steps > steps_of(finest_))) return;
  }
}

void AccuracyMeasurement::measure_linear() {
  for (double tolerance : kLinearTolerances) {
    Run tried{.axis = Axis::linear, .setting = as_in_scene(scene_.time.integrator, scene_step_)};
    tried.setting.linear_tolerance = tolerance;
    run(tried, reference_);
    result_.runs.push_back(std::move(tried));
  }
}

// Runs meshes from fine to coarse. Compares each with the mesh that has twice the cells along each side, if that mesh
// was run. Lists the results from coarse to fine.
void AccuracyMeasurement::measure_meshes() {
  std::map<double, SamplePtr> by_refinement;  // twice a key is exact in binary
  const auto first = static_cast<std::ptrdiff_t>(result_.runs.size());
  std::set<double, std::greater<>> asked, all(std::begin(kRefinements), std::end(kRefinements));  // finest first
  if (plan_.meshes) {
    asked.insert(plan_.meshes->begin(), plan_.meshes->end());
    all = asked;
    for (const double refinement : asked) all.insert(2 * refinement);
  }
  for (const double refinement : all) {
    if (!run_error::can_refine(scene_, refinement)) continue;
    Run tried{.axis = Axis::mesh, .setting = as_in_scene(result_.reference.setting.integrator, 0.5 * scene_step_)};
    tried.setting.newton_tolerance = tighter_newton_tolerance(tried.setting.newton_tolerance, kMeshNewtonRatio);
    tried.setting.refinement = refinement;
    const auto twice = by_refinement.find(2 * refinement);
    const SamplePtr against = twice == by_refinement.end() ? nullptr : twice->second;
    by_refinement[refinement] =
        run(tried, against,
            against ? run_error::matching_particles_in_refined(scene_with(tried.setting)) : std::vector<std::size_t>{});
    // Omits a mesh that was run only for comparison, unless its run fails.
    const bool extra = plan_.meshes ? !asked.contains(refinement) : refinement == kRefinements[0];
    if (extra && !tried.failed()) continue;
    if (!against && !tried.failed()) tried.failure = "nothing finer to compare with";
    result_.runs.insert(result_.runs.begin() + first, std::move(tried));
  }
}

Accuracy AccuracyMeasurement::measure() {
  // Rough estimate of the work: for each step, three values of newton_tolerance; for all other axes together, half of
  // that; for each reference, three runs at its step.
  constexpr double kRunsOfAStep = 3, kRunsOfAReference = 3;
  for (const double step : steps_)
    work_ += static_cast<double>(integrators_.size()) * kRunsOfAStep * work_of(as_in_scene(best_, step));
  work_ *= 1.5;
  work_ += 2 * kRunsOfAReference * work_of(as_in_scene(best_, finest_ / reference_step_divisor()));
  measure_references();
  for (const Integrator integrator : integrators_) {
    measure_steps(integrator);
    measure_tolerances(integrator);
  }
  raise_uncertainty(result_.uncertainty, result_.cross_checks);
  measure_linear();
  measure_meshes();
  return std::move(result_);
}

}  // namespace

Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each, const AccuracyPlan& plan) {
  return AccuracyMeasurement(scene, each, plan).measure();
}

}  // namespace weft::bench
