#include "bench/companions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"

namespace weft::bench {
namespace {

// Displacement of the start that should not matter [m].
constexpr double kShift = 1e-6;
// A start moved by a micrometre that comes out as so large a share of what steps and solver leave tells that paths
// part.
constexpr double kParts = 0.3;
// And so does, whatever those leave, one that comes out as a thousand times as much.
constexpr double kAmplified = 1e3;
constexpr double kTighter = 0.1;  // newton_tolerance of the companion, in shares of the run's
// Observed orders are believed between this share of the expected one and all of it: stiff waves and borders lower
// them, and where nothing is left of them differences are no error that falls with step or spacing.
constexpr double kLeastOrder = 0.5;
// Where there is one companion alone: between.
constexpr double kAssumedOrder = 0.75;
// Cells along each side from which on a mesh tells of an order.
constexpr int kFewCells = 4;
// Bending and stretch are of second order in the spacing.
constexpr double kMeshOrder = 2;

double order_of(scene::Integrator integrator) {
  return integrator == scene::Integrator::implicit_euler ? 1 : 2;
}

double steps_a_frame(const scene::Time& time) {
  return std::max(1.0, std::ceil(1 / (time.fps * time.step) - 1e-9));
}

// What a companion changes: it has steps or spacings `ratio` times those of the run.
struct Change {
  double ratio;
  Errors errors;
};

// The order p at which errors C h^p explain two changes, C h^p |r^p - 1| each, the first of longer steps or spacings:
// their quotient grows with p. The nearest between `least` and `most`.
double observed_order(double coarse_ratio, double fine_ratio, double quotient, double least, double most) {
  constexpr int kHalvings = 30;
  const auto expected = [&](double p) {
    return std::abs(std::pow(coarse_ratio, p) - 1) / std::abs(std::pow(fine_ratio, p) - 1);
  };
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (least + most);
    (expected(middle) < quotient ? least : most) = middle;
  }
  return 0.5 * (least + most);
}

// The error of a run of this order that differs so from a companion, and if there is one from another that is coarser
// than both.
Errors richardson(double order, const Change& change, const std::optional<Change>& coarser) {
  Errors errors{};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    double p = kAssumedOrder * order;
    if (coarser && change.errors[q] > 0)
      p = observed_order(coarser->ratio, change.ratio, coarser->errors[q] / change.errors[q], kLeastOrder * order,
                         order);
    errors[q] = change.errors[q] / std::abs(std::pow(change.ratio, p) - 1);
  }
  return errors;
}

// Simulates companions of one run.
class Companions {
 public:
  Companions(const scene::Scene& scene, Trajectory run, const CompanionOptions& options)
      : scene_(scene), run_(std::move(run)), options_(options) {}

  ErrorEstimate estimate();

 private:
  Trajectory follow(const scene::Scene& scene);
  Errors difference(const scene::Scene& scene);
  ErrorPart part(ErrorSource source, const std::function<Errors()>& measure);
  Errors of_steps();
  Errors of_solver();
  Errors of_mesh();
  Errors of_start();
  Change of_step(double ratio);

  scene::Scene scene_;
  Trajectory run_;  // in `scene_`
  const CompanionOptions& options_;
  ErrorEstimate result_;
};

Trajectory Companions::follow(const scene::Scene& scene) {
  FollowLimits limits{.last_frame = static_cast<int>(run_.frames.size()), .proceed = options_.proceed};
  Trajectory trajectory = bench::follow(scene, limits);
  result_.cpu_s += trajectory.work.cpu_s;
  return trajectory;
}

// Of a companion with the same particles.
Errors Companions::difference(const scene::Scene& scene) {
  return compare(follow(scene), run_);
}

ErrorPart Companions::part(ErrorSource source, const std::function<Errors()>& measure) {
  ErrorPart part{source};
  try {
    part.errors = measure();
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
    part.missing = error.what();
  }
  return part;
}

// With steps as near to `ratio` times those of the run as frames can be cut.
Change Companions::of_step(double ratio) {
  scene::Scene companion = scene_;
  if (scene_.time.tolerance) {
    // Steps go as t^(1 / (p + 1)).
    *companion.time.tolerance *= std::pow(ratio, order_of(scene_.time.integrator) + 1);
    return {ratio, difference(companion)};
  }
  const double steps = steps_a_frame(scene_.time), taken = std::floor(steps / ratio);
  companion.time.step = 1 / (scene_.time.fps * taken);
  return {steps / taken, difference(companion)};
}

Errors Companions::of_steps() {
  const double order = order_of(scene_.time.integrator);
  const Change half = of_step(0.5);
  // One step a frame cannot become longer.
  if (!scene_.time.tolerance && steps_a_frame(scene_.time) < 2) return richardson(order, half, std::nullopt);
  std::optional<Change> twice;
  const ErrorPart longer = part(ErrorSource::steps, [&] {
    twice = of_step(2);
    return twice->errors;
  });
  const double least = kLeastOrder * order, near = at(half.errors, Quantity::position);
  result_.steps_irregular =
      !twice || at(twice->errors, Quantity::position) * std::abs(std::pow(half.ratio, least) - 1) <
                    near * std::abs(std::pow(twice->ratio, least) - 1);
  return richardson(order, half, twice);
}

// What the solver leaves is taken as proportional to the tolerance.
Errors Companions::of_solver() {
  scene::Scene companion = scene_;
  companion.solver.newton_tolerance *= kTighter;
  Trajectory solved = follow(companion);
  Errors errors = compare(solved, run_);
  for (double& error : errors) error /= 1 - kTighter;
  // From here on all companions are solved so, lest what the solver leaves is taken for an error of steps and meshes.
  scene_ = std::move(companion);
  run_ = std::move(solved);
  return errors;
}

Errors Companions::of_mesh() {
  if (!can_refine(scene_, 0.5)) throw Error(ExitCode::usage, "the cells cannot be halved");
  const auto coarse = [&](double refinement) {
    scene::Scene companion = scene_;
    refine(companion, refinement);
    return companion;
  };
  const scene::Scene half = coarse(0.5);
  const Trajectory halved = follow(half);
  const std::vector<std::size_t> same = same_in_twice_as_fine(half);
  const Change change{2, compare(halved, run_, same)};
  const bool few = std::any_of(scene_.cloths.begin(), scene_.cloths.end(), [](const scene::Cloth& cloth) {
    return std::min(cloth.particles_weft, cloth.particles_warp) - 1 < 4 * kFewCells;
  });
  if (few || !can_refine(scene_, 0.25)) return richardson(kMeshOrder, change, std::nullopt);
  const scene::Scene quarter = coarse(0.25);
  std::vector<std::size_t> same_again = same_in_twice_as_fine(quarter);
  for (std::size_t& particle : same_again) particle = same[particle];
  return richardson(kMeshOrder, change, Change{4, compare(follow(quarter), run_, same_again)});
}

Errors Companions::of_start() {
  scene::Scene companion = scene_;
  for (scene::Cloth& cloth : companion.cloths) cloth.start_noise += kShift;
  return difference(companion);
}

ErrorEstimate Companions::estimate() {
  ErrorPart mesh{ErrorSource::mesh}, start = part(ErrorSource::start, [&] { return of_start(); }),
                                     solver = part(ErrorSource::solver, [&] { return of_solver(); }),
                                     steps = part(ErrorSource::steps, [&] { return of_steps(); });
  if (options_.mesh) mesh = part(ErrorSource::mesh, [&] { return of_mesh(); });
  const double left = std::hypot(at(steps.errors, Quantity::position), at(solver.errors, Quantity::position)),
               moved = at(start.errors, Quantity::position);
  result_.start_matters = !start.missing.empty() || moved > std::clamp(kParts * left, 10 * kShift, kAmplified * kShift);
  result_.parts = {std::move(steps), std::move(solver), std::move(start)};
  if (options_.mesh) result_.parts.push_back(std::move(mesh));
  for (const ErrorPart& each : result_.parts)
    for (std::size_t q = 0; q < kQuantities; ++q) result_.all[q] = std::hypot(result_.all[q], each.errors[q]);
  return std::move(result_);
}

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::string_view kNames[kErrorSources] = {"time steps", "solver", "mesh", "start"};
  return kNames[static_cast<std::size_t>(source)];
}

const ErrorPart& ErrorEstimate::largest() const {
  return *std::max_element(parts.begin(), parts.end(), [](const ErrorPart& a, const ErrorPart& b) {
    return at(a.errors, Quantity::position) < at(b.errors, Quantity::position);
  });
}

ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options) {
  return Companions(scene, std::move(run), options).estimate();
}

}  // namespace weft::bench
