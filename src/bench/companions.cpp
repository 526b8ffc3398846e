#include "bench/companions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"

namespace weft::bench {
namespace {

// Displacements of the start that should not matter [m]; those after the first only where it does.
constexpr double kShifts[] = {1e-6, 2e-6, 3e-6};
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

Quantity quantity(std::size_t q) {
  return static_cast<Quantity>(q);
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
  Errors of_start(std::size_t shifts);
  Errors beyond_start(Errors difference) const;
  Errors richardson(double ratio, double order, Errors near, std::optional<Errors> far) const;

  scene::Scene scene_;
  Trajectory run_;  // in `scene_`
  const CompanionOptions& options_;
  std::vector<Errors> shifted_;  // differences to runs from moved starts
  Errors start_{};
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

// What of a difference is not due to the start: each of two runs is off the middle of all equal ones by start_.
Errors Companions::beyond_start(Errors difference) const {
  for (std::size_t q = 0; q < kQuantities; ++q)
    difference[q] = std::sqrt(std::max(0.0, difference[q] * difference[q] - 2 * start_[q] * start_[q]));
  return difference;
}

// The error of the run, from the difference to a companion `ratio` times as coarse and, if there is one, to a companion
// ratio² times as coarse: with errors C h^p the differences are C h^p (r^p - 1) and C h^p (r^2p - 1), so that
// far / near - 1 = r^p. Finer companions have a ratio below 1. What is no larger than twice what the start does is not
// made larger: there is no order in it.
Errors Companions::richardson(double ratio, double order, Errors near, std::optional<Errors> far) const {
  near = beyond_start(near);
  if (far) far = beyond_start(*far);
  Errors errors{};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    double p = kAssumedOrder * order;
    if (far && near[q] > 0) p = std::log((*far)[q] / near[q] - 1) / std::log(ratio);
    p = std::isfinite(p) ? std::clamp(p, kLeastOrder * order, order) : kLeastOrder * order;
    const double factor = 1 / std::abs(std::pow(ratio, p) - 1);
    errors[q] = near[q] * (near[q] > 2 * start_[q] ? factor : std::min(1.0, factor));
  }
  return errors;
}

Errors Companions::of_steps() {
  const double order = order_of(scene_.time.integrator);
  scene::Scene companion = scene_;
  if (scene_.time.tolerance) {
    // Steps go as t^(1 / (p + 1)).
    const double twice = std::pow(2, order + 1);
    companion.time.tolerance = twice * *scene_.time.tolerance;
    const Errors near = difference(companion);
    companion.time.tolerance = twice * twice * *scene_.time.tolerance;
    return richardson(2, order, near, difference(companion));
  }
  const double frame = 1 / scene_.time.fps;
  const int steps = std::max(1, static_cast<int>(std::ceil(frame / scene_.time.step - 1e-9)));
  // One step a frame cannot become longer.
  const int fewer = steps > 1 ? steps / 2 : 2;
  companion.time.step = frame / fewer;
  const Errors near = difference(companion);
  const double ratio = static_cast<double>(steps) / fewer;
  if (ratio != 2 || fewer % 2 != 0) return richardson(ratio, order, near, std::nullopt);
  companion.time.step *= 2;
  return richardson(ratio, order, near, difference(companion));
}

// What the solver leaves is taken as proportional to the tolerance.
Errors Companions::of_solver() {
  scene::Scene companion = scene_;
  companion.solver.newton_tolerance *= kTighter;
  Trajectory solved = follow(companion);
  Errors errors = beyond_start(compare(solved, run_));
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
  const Errors near = compare(halved, run_, same);
  const bool few = std::any_of(scene_.cloths.begin(), scene_.cloths.end(), [](const scene::Cloth& cloth) {
    return std::min(cloth.particles_weft, cloth.particles_warp) - 1 < 4 * kFewCells;
  });
  if (few || !can_refine(scene_, 0.25)) return richardson(2, kMeshOrder, near, std::nullopt);
  const scene::Scene quarter = coarse(0.25);
  std::vector<std::size_t> same_again = same_in_twice_as_fine(quarter);
  for (std::size_t& particle : same_again) particle = same[particle];
  return richardson(2, kMeshOrder, near, compare(follow(quarter), run_, same_again));
}

// Paths: the largest difference. Functionals: how far one of equal runs is from the middle of them all, which is 1/√2
// of what two of them differ by.
Errors Companions::of_start(std::size_t shifts) {
  while (shifted_.size() < shifts) {
    scene::Scene companion = scene_;
    for (scene::Cloth& cloth : companion.cloths) cloth.start_noise += kShifts[shifted_.size()];
    shifted_.push_back(difference(companion));
  }
  Errors errors{};
  for (const Errors& one : shifted_) {
    for (std::size_t q = 0; q < kQuantities; ++q)
      errors[q] = quantity(q) <= Quantity::velocity
                      ? std::max(errors[q], one[q])
                      : std::hypot(errors[q], one[q] / std::sqrt(2.0 * static_cast<double>(shifts)));
  }
  return errors;
}

ErrorEstimate Companions::estimate() {
  ErrorPart start = part(ErrorSource::start, [&] { return of_start(1); });
  start_ = start.errors;
  ErrorPart mesh{ErrorSource::mesh}, solver = part(ErrorSource::solver, [&] { return of_solver(); }),
                                     steps = part(ErrorSource::steps, [&] { return of_steps(); });
  if (options_.mesh) mesh = part(ErrorSource::mesh, [&] { return of_mesh(); });
  const double left = std::hypot(at(steps.errors, Quantity::position), at(solver.errors, Quantity::position)),
               moved = at(start_, Quantity::position);
  result_.comparable =
      start.missing.empty() && moved <= std::clamp(kParts * left, 10 * kShifts[0], kAmplified * kShifts[0]);
  if (!result_.comparable) start = part(ErrorSource::start, [&] { return of_start(std::size(kShifts)); });
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
  return *std::max_element(parts.begin(), parts.end(), [this](const ErrorPart& a, const ErrorPart& b) {
    return at(a.errors, deciding()) < at(b.errors, deciding());
  });
}

ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options) {
  return Companions(scene, std::move(run), options).estimate();
}

}  // namespace weft::bench
