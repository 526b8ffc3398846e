#include "bench/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "simulation/collision_stage.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

// Fixed steps: from four times the scene's on, each half of the one before.
constexpr int kSteps = 6;
constexpr double kCoarsest = 4;
// How much finer the steps of the references are than the finest measured: of second order, their error is then below a
// sixtieth of theirs. With contact it is that of diverging paths rather than that of steps.
constexpr int kReferenceCut = 8, kReferenceCutWithContact = 2;
// Tolerances of positions [m], half a decade apart, until steps are shorter than the fixed ones.
constexpr double kLargestTolerance = 1e-3;
constexpr int kTolerances = 9, kTolerancesWithContact = 5;
// newton_tolerance falls by decades from the scene's down to this.
constexpr double kLeastNewton = 1e-8, kDecade = 0.1;
// That of the runs with other meshes, in shares of the scene's.
constexpr double kNewtonOfMeshes = 1e-2;
// What a tenfold smaller newton_tolerance may change where the step is to decide, in shares of the error.
constexpr double kDecides = 0.1;
constexpr double kLinearTolerances[] = {0.3, 0.1, 0.03, 0.01, 0.003};
constexpr double kRefinements[] = {2, 1, 0.5, 0.25};
// Starts with contact, each moved by a micrometre more than the one before [m].
constexpr double kShiftOfStart = 1e-6;
constexpr int kStarts = 3;
// Runs shorter than this [s] are timed twice.
constexpr double kShortRun = 0.3;
// A run that halves its steps over and over is stopped after so many times the steps it should take, or those of the
// finest one where these are more.
constexpr int kStepLimit = 3;

// Runs of one setting from one start, or with contact from several.
struct Sample {
  std::vector<Trajectory> starts;
  Functionals middle;
  Errors spread{};
  Work work;
};

Errors difference(const Sample& a, const Sample& b, const std::vector<std::size_t>& same = {}) {
  return a.starts.size() > 1 ? compare(a.middle, b.middle) : compare(a.starts[0], b.starts[0], same);
}

// As `measure_accuracy` does it, step by step.
class Campaign {
 public:
  Campaign(const scene::Scene& scene, const EachRun& each);
  Accuracy measure();

 private:
  using SamplePtr = std::shared_ptr<const Sample>;

  scene::Scene with(const Setting& setting) const;
  Setting as_in_scene(Integrator integrator, double step) const {
    return {integrator, step, {}, scene_.solver.newton_tolerance, scene_.solver.linear_tolerance};
  }
  int steps_of(double step) const {
    return result_.frames * static_cast<int>(std::lround(1 / (scene_.time.fps * step)));
  }
  double work_of(const Setting& setting) const;

  SamplePtr sample(const Setting& setting) const;
  SamplePtr run(Run& run, const SamplePtr& against, const std::vector<std::size_t>& same = {});
  SamplePtr made(const Setting& setting);
  Errors tighten(Setting& twice, SamplePtr& coarse);
  SamplePtr measure_candidate(Candidate& candidate);
  void measure_references();
  void measure_grid(Integrator integrator, double step);
  bool decides(const Run& run, const Run& tighter) const;
  void measure_tolerances(Integrator integrator);
  void measure_linear();
  void measure_meshes();

  const scene::Scene& scene_;
  const EachRun& each_;
  Accuracy result_;
  double finest_ = 0, scene_step_ = 0;  // steps [s]
  Integrator best_, other_;             // that of the reference, and of the one beside it
  SamplePtr reference_;
  double work_ = 0, work_done_ = 0;  // [steps]
};

Campaign::Campaign(const scene::Scene& scene, const EachRun& each) : scene_(scene), each_(each) {
  result_.contact = simulation::CollisionStage::needed(scene);
  result_.frames = scene.frame_count() - 1;
  result_.duration = result_.frames / scene.time.fps;
  best_ = result_.contact ? Integrator::bdf2 : Integrator::implicit_midpoint;
  other_ = result_.contact ? Integrator::implicit_euler : Integrator::bdf2;
  // Frames are cut into equal steps, so that the steps asked for are the steps taken.
  const double coarsest = std::max(1.0, std::round(1 / (scene.time.fps * kCoarsest * scene.time.step)));
  scene_step_ = 1 / (scene.time.fps * coarsest * kCoarsest);
  finest_ = 1 / (scene.time.fps * coarsest * std::pow(2.0, kSteps - 1));
  result_.of_scene = as_in_scene(scene.time.integrator, scene_step_);
}

scene::Scene Campaign::with(const Setting& setting) const {
  scene::Scene scene = scene_;
  scene.time.integrator = setting.integrator;
  scene.time.step = setting.step;
  scene.time.tolerance = setting.tolerance;
  scene.solver.newton_tolerance = setting.newton_tolerance;
  scene.solver.linear_tolerance = setting.linear_tolerance;
  if (setting.refinement != 1) refine(scene, setting.refinement);
  return scene;
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

// Throws where one of its runs does not reach the end.
Campaign::SamplePtr Campaign::sample(const Setting& setting) const {
  const FollowLimits limits{.steps = kStepLimit *
                                     std::max(steps_of(finest_), setting.tolerance ? 0 : steps_of(setting.step))};
  auto sample = std::make_shared<Sample>();
  std::vector<Functionals> functionals;
  scene::Scene scene = with(setting);
  for (int start = 0; start < (result_.contact ? kStarts : 1); ++start) {
    sample->starts.push_back(follow(scene, limits));
    functionals.push_back(sample->starts.back().functionals);
    for (scene::Cloth& cloth : scene.cloths) cloth.start_noise += kShiftOfStart;
  }
  sample->middle = median(functionals);
  sample->work = sample->starts[0].work;
  for (const Trajectory& start : sample->starts) {
    sample->work.cpu_s = std::min(sample->work.cpu_s, start.work.cpu_s);
    const Errors apart = compare(start.functionals, sample->middle);
    for (std::size_t q = 0; q < kQuantities; ++q) sample->spread[q] = std::max(sample->spread[q], apart[q]);
  }
  if (!result_.contact && sample->work.cpu_s < kShortRun)
    sample->work.cpu_s = std::min(sample->work.cpu_s, follow(scene, limits).work.cpu_s);
  return sample;
}

// What a setting comes to; nothing where it fails, which the run then says.
Campaign::SamplePtr Campaign::run(Run& run, const SamplePtr& against, const std::vector<std::size_t>& same) {
  SamplePtr made;
  try {
    made = sample(run.setting);
    run.spread = made->spread;
    run.work = made->work;
    run.particles = static_cast<int>(made->starts[0].masses.size());
    if (against) run.errors = difference(*made, *against, same);
  } catch (const Error& error) {
    run.failure = error.what();
  }
  work_done_ += work_of(run.setting);
  if (each_) each_(run, std::min(1.0, work_done_ / work_));
  return made;
}

// A run of a reference; throws where it fails.
Campaign::SamplePtr Campaign::made(const Setting& setting) {
  Run tried{.setting = setting};
  SamplePtr sample = run(tried, nullptr);
  if (!sample) throw Error(ExitCode::simulation_failed, "{}", tried.failure);
  return sample;
}

// Makes newton_tolerance of runs with twice the step of a reference tenfold smaller until that changes less than a
// tenth of what the step of the reference does, or it fails. `coarse` becomes the last of them. Returns the last
// change.
Errors Campaign::tighten(Setting& twice, SamplePtr& coarse) {
  const Quantity decides = deciding_quantity(result_);
  const double order = expected_order({.setting = twice});
  for (Errors change{};;) {
    Run tighter{.setting = twice};
    tighter.setting.newton_tolerance = std::max(kLeastNewton, kDecade * twice.newton_tolerance);
    const SamplePtr sample = run(tighter, coarse);
    // Not before it was seen what a tenfold smaller one changes.
    if (!sample && at(change, decides) == 0) throw Error(ExitCode::simulation_failed, "{}", tighter.failure);
    if (!sample) return change;
    change = tighter.errors;
    twice = tighter.setting;
    coarse = sample;
    Setting four_times = twice;
    four_times.step *= 2;
    const double step = at(difference(*coarse, *made(four_times)), decides) / std::pow(2, order);
    const bool exact = at(change, decides) <= std::max(kDecides * step, at(sample->spread, decides));
    if (exact || twice.newton_tolerance <= kLeastNewton) return change;
  }
}

// Its tolerance is found at twice its step.
Campaign::SamplePtr Campaign::measure_candidate(Candidate& candidate) {
  try {
    Setting twice = candidate.setting;
    twice.step *= 2;
    SamplePtr coarse = made(twice);
    candidate.solver = tighten(twice, coarse);
    candidate.setting.newton_tolerance = twice.newton_tolerance;
    SamplePtr fine = made(candidate.setting);
    candidate.step = difference(*coarse, *fine);
    candidate.spread = fine->spread;
    candidate.energies_in_play = fine->middle.energies_in_play;
    return fine;
  } catch (const Error& error) {
    candidate.failure = error.what();
    return nullptr;
  }
}

void Campaign::measure_references() {
  const double step = finest_ / (result_.contact ? kReferenceCutWithContact : kReferenceCut);
  Candidate first{as_in_scene(best_, step)}, second{as_in_scene(other_, step)};
  reference_ = measure_candidate(first);
  SamplePtr beside = measure_candidate(second);
  if (!reference_ && !beside) throw Error(ExitCode::simulation_failed, "the reference run failed: {}", first.failure);
  const Quantity decides = deciding_quantity(result_);
  if (!reference_ || (beside && at(second.doubt(), decides) < at(first.doubt(), decides))) {
    std::swap(first, second);
    std::swap(reference_, beside);
  }
  result_.uncertainty = first.doubt();
  if (beside) {
    result_.apart = difference(*reference_, *beside);
    const Errors explained = second.doubt();
    for (std::size_t q = 0; q < kQuantities; ++q)
      result_.uncertainty[q] = std::max(result_.uncertainty[q], result_.apart[q] - explained[q]);
  }
  result_.largest_energy = first.energies_in_play;
  result_.reference = std::move(first);
  result_.second = std::move(second);
}

bool Campaign::decides(const Run& run, const Run& tighter) const {
  const Quantity q = deciding_quantity(result_);
  return run.change <= std::max(kDecides * error_of(tighter, q), result_.doubt(tighter, q));
}

// One step with newton_tolerance from that of the scene down, until the step decides.
void Campaign::measure_grid(Integrator integrator, double step) {
  std::vector<Run> runs;
  std::vector<SamplePtr> samples;
  const Quantity q = deciding_quantity(result_);
  Setting setting = as_in_scene(integrator, step);
  while (true) {
    runs.push_back({.axis = Axis::grid, .setting = setting});
    samples.push_back(run(runs.back(), reference_));
    if (!samples.back()) break;
    if (runs.size() > 1) {
      Run& before = runs[runs.size() - 2];
      before.change = at(difference(*samples[runs.size() - 2], *samples.back()), q);
      before.step_decides = decides(before, runs.back());
      if (before.step_decides) break;
    }
    if (setting.newton_tolerance <= kLeastNewton) break;
    setting.newton_tolerance = std::max(kLeastNewton, kDecade * setting.newton_tolerance);
  }
  const auto tightest = std::find_if(samples.rbegin(), samples.rend(), [](const SamplePtr& s) { return s != nullptr; });
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (samples[k]) runs[k].left = at(difference(*samples[k], **tightest), q);
  result_.runs.insert(result_.runs.end(), std::make_move_iterator(runs.begin()), std::make_move_iterator(runs.end()));
}

void Campaign::measure_tolerances(Integrator integrator) {
  for (int k = 0; k < (result_.contact ? kTolerancesWithContact : kTolerances); ++k) {
    Run tried{.axis = Axis::tolerance, .setting = as_in_scene(integrator, scene_step_)};
    tried.setting.tolerance = kLargestTolerance * std::pow(10.0, -0.5 * k);
    run(tried, reference_);
    result_.runs.push_back(std::move(tried));
    if (result_.runs.back().failed() || result_.runs.back().work.steps > steps_of(finest_)) return;
  }
}

void Campaign::measure_linear() {
  for (double tolerance : kLinearTolerances) {
    Run tried{.axis = Axis::linear, .setting = as_in_scene(scene_.time.integrator, scene_step_)};
    tried.setting.linear_tolerance = tolerance;
    run(tried, reference_);
    result_.runs.push_back(std::move(tried));
  }
}

// From fine to coarse, each held against the one before; listed from coarse to fine.
void Campaign::measure_meshes() {
  SamplePtr finer;
  const auto first = static_cast<std::ptrdiff_t>(result_.runs.size());
  for (double refinement : kRefinements) {
    if (!can_refine(scene_, refinement)) continue;
    Run tried{.axis = Axis::mesh, .setting = as_in_scene(best_, 0.5 * scene_step_)};
    tried.setting.newton_tolerance = std::max(kLeastNewton, kNewtonOfMeshes * tried.setting.newton_tolerance);
    tried.setting.refinement = refinement;
    const SamplePtr against = std::move(finer);
    finer = run(tried, against, against ? same_in_twice_as_fine(with(tried.setting)) : std::vector<std::size_t>{});
    if (!against && !tried.failed()) {
      // The finest is there for the next one alone.
      if (refinement == kRefinements[0]) continue;
      tried.failure = "nothing finer to compare with";
    }
    result_.runs.insert(result_.runs.begin() + first, std::move(tried));
  }
}

Accuracy Campaign::measure() {
  // About: three tolerances for each step; references with three runs at twice their step.
  constexpr double kRunsOfAStep = 3, kRunsOfAReference = 3;
  for (double step = finest_; step < 1.5 * kCoarsest * scene_step_; step *= 2)
    work_ += std::size(kIntegrators) * kRunsOfAStep * work_of(as_in_scene(best_, step));
  work_ *= 1.5;
  work_ += 2 * kRunsOfAReference *
           work_of(as_in_scene(best_, finest_ / (result_.contact ? kReferenceCutWithContact : kReferenceCut)));
  measure_references();
  for (Integrator integrator : kIntegrators) {
    for (int k = kSteps; k-- > 0;) measure_grid(integrator, finest_ * std::pow(2.0, k));
    measure_tolerances(integrator);
  }
  measure_linear();
  measure_meshes();
  return std::move(result_);
}

}  // namespace

Errors Candidate::doubt() const {
  Errors doubt{};
  for (std::size_t q = 0; q < kQuantities; ++q) doubt[q] = std::hypot(step[q], solver[q], spread[q]);
  return doubt;
}

double control_of(const Run& run) {
  switch (run.axis) {
    case Axis::grid:
      return run.setting.step;
    case Axis::tolerance:
      return run.setting.tolerance.value_or(0);
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
    case Axis::grid:
      return order;
    case Axis::tolerance:
      return order / (order + 1);
    case Axis::mesh:
      return 1;
    case Axis::linear:
      return 0;
  }
  return 0;
}

std::vector<Quantity> quantities_of(const Accuracy& accuracy) {
  if (!accuracy.contact)
    return {Quantity::position, Quantity::velocity, Quantity::energy, Quantity::drift, Quantity::centre};
  return {Quantity::centre, Quantity::energy, Quantity::drift, Quantity::shadow, Quantity::top, Quantity::rest_energy};
}

Quantity deciding_quantity(const Accuracy& accuracy) {
  return quantities_of(accuracy).front();
}

std::vector<const Run*> Accuracy::series(Axis axis, Integrator integrator) const {
  std::vector<const Run*> found;
  for (const Run& run : runs)
    if (run.axis == axis && run.setting.integrator == integrator) found.push_back(&run);
  return found;
}

std::vector<const Run*> Accuracy::decided(Integrator integrator) const {
  std::vector<const Run*> found;
  for (const Run* run : series(Axis::grid, integrator))
    if (run->step_decides) found.push_back(run);
  return found;
}

Accuracy measure_accuracy(const scene::Scene& scene, const EachRun& each) {
  return Campaign(scene, each).measure();
}

}  // namespace weft::bench
