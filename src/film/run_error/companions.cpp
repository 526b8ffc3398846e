#include "film/run_error/companions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"

namespace weft::run_error {
namespace {

// Maximum displacement of a particle at the start, in the companion for ErrorSource::start [m].
constexpr double kStartDisplacement = 1e-6;
// The motion is chaotic if the difference in position due to kStartDisplacement exceeds both ten times
// kStartDisplacement and kChaosRatio times the step and solver errors.
constexpr double kChaosRatio = 0.3;
// The motion is also chaotic if this difference exceeds kMaxAmplification times kStartDisplacement, whatever the step
// and solver errors are.
constexpr double kMaxAmplification = 1e3;
constexpr double kCompanionToleranceRatio = 0.1;  // newton_tolerance of the companion, relative to the run's
// Observed orders are limited to the range from kMinOrderRatio times the expected order to the expected order. Stiff
// waves and borders of the cloth lower the observed order. Below the limit, the two companions differ from the run by
// nearly the same amount, which says little about the order.
constexpr double kMinOrderRatio = 0.5;
// Fraction of the expected order that is assumed if there is only one companion.
constexpr double kAssumedOrderRatio = 0.75;
// Minimum number of cells along each side of the coarsest mesh. With fewer, the order is assumed instead of observed.
constexpr int kMinCellsForOrder = 4;
// Expected order of the error in the particle spacing: bending and stretch converge with second order.
constexpr double kMeshOrder = 2;

double order_of(scene::Integrator integrator) {
  return integrator == scene::Integrator::implicit_euler ? 1 : 2;
}

double steps_a_frame(const scene::Time& time) {
  return std::max(1.0, std::ceil(1 / (time.fps * time.step) - kRoundoff));
}

// Difference between the run and a companion whose step or spacing is `ratio` times that of the run.
struct Change {
  double ratio;
  Errors errors;
};

// Finds the order p in [least, most] by bisection. With an error C h^p, where h is the step or spacing of the run, a
// companion with the ratio r differs from the run by C h^p |r^p - 1|. `quotient`: difference of the coarser companion /
// difference of the finer one; this quotient grows with p.
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

// Error of a run, extrapolated from its difference to one companion (`change`) and, if given, to a coarser companion.
// `order`: the expected order.
Errors richardson(double order, const Change& change, const std::optional<Change>& coarser) {
  Errors errors{};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    double p = kAssumedOrderRatio * order;
    if (coarser && change.errors[q] > 0)
      p = observed_order(coarser->ratio, change.ratio, coarser->errors[q] / change.errors[q], kMinOrderRatio * order,
                         order);
    errors[q] = change.errors[q] / std::abs(std::pow(change.ratio, p) - 1);
  }
  return errors;
}

// Simulates the companions of one run.
class Companions {
 public:
  Companions(const scene::Scene& scene, Trajectory run, const CompanionOptions& options)
      : scene_(scene), run_(std::move(run)), options_(options) {}

  ErrorEstimate estimate() {
    ErrorPart mesh{ErrorSource::mesh}, start = part(ErrorSource::start, [&] { return measure_start_error(); }),
                                       solver = part(ErrorSource::solver, [&] { return measure_solver_error(); }),
                                       steps = part(ErrorSource::steps, [&] { return measure_step_error(); });
    if (options_.mesh) mesh = part(ErrorSource::mesh, [&] { return measure_mesh_error(); });
    const double left = std::hypot(at(steps.errors, Quantity::position), at(solver.errors, Quantity::position)),
                 moved = at(start.errors, Quantity::position);
    result_.is_chaotic = !start.missing.empty() || moved > std::clamp(kChaosRatio * left, 10 * kStartDisplacement,
                                                                      kMaxAmplification * kStartDisplacement);
    result_.parts = {std::move(steps), std::move(solver), std::move(start)};
    if (options_.mesh) result_.parts.push_back(std::move(mesh));
    for (const ErrorPart& each : result_.parts)
      for (std::size_t q = 0; q < kQuantities; ++q) result_.all[q] = std::hypot(result_.all[q], each.errors[q]);
    return std::move(result_);
  }

 private:
  Trajectory follow(const scene::Scene& scene) {
    FollowLimits limits{.last_frame = static_cast<int>(run_.frames.size()), .proceed = options_.proceed};
    Trajectory trajectory = run_error::follow(scene, limits);
    result_.cpu_s += trajectory.work.cpu_s;
    return trajectory;
  }

  // Simulates `scene`, a companion with the same particles as the run, and returns its difference to the run.
  Errors difference(const scene::Scene& scene) { return compare(follow(scene), run_); }

  ErrorPart part(ErrorSource source, const std::function<Errors()>& measure) {
    ErrorPart part{source};
    try {
      part.errors = measure();
    } catch (const Error& error) {
      if (error.code() == ExitCode::interrupted) throw;
      part.missing = error.what();
    }
    return part;
  }

  // Simulates a companion and returns its difference to the run. Its step is the shortest one that is at least `ratio`
  // times the step of the run and divides a frame evenly. If the scene has time.tolerance, the companion has a
  // tolerance that multiplies the steps by `ratio`.
  Change change_with_step(double ratio) {
    scene::Scene companion = scene_;
    if (scene_.time.tolerance) {
      // The step scales as tolerance^(1 / (order + 1)).
      *companion.time.tolerance *= std::pow(ratio, order_of(scene_.time.integrator) + 1);
      return {ratio, difference(companion)};
    }
    const double steps = steps_a_frame(scene_.time), taken = std::floor(steps / ratio);
    companion.time.step = 1 / (scene_.time.fps * taken);
    return {steps / taken, difference(companion)};
  }

  Errors measure_step_error() {
    const double order = order_of(scene_.time.integrator);
    const Change half = change_with_step(0.5);
    // A step as long as a frame cannot be doubled.
    if (!scene_.time.tolerance && steps_a_frame(scene_.time) < 2) return richardson(order, half, std::nullopt);
    std::optional<Change> twice;
    const ErrorPart longer = part(ErrorSource::steps, [&] {
      twice = change_with_step(2);
      return twice->errors;
    });
    const double least = kMinOrderRatio * order, near = at(half.errors, Quantity::position);
    result_.steps_irregular =
        !twice || at(twice->errors, Quantity::position) * std::abs(std::pow(half.ratio, least) - 1) <
                      near * std::abs(std::pow(twice->ratio, least) - 1);
    return richardson(order, half, twice);
  }

  // Assumes that the error of the solver is proportional to newton_tolerance.
  Errors measure_solver_error() {
    scene::Scene companion = scene_;
    companion.solver.newton_tolerance *= kCompanionToleranceRatio;
    Trajectory solved = follow(companion);
    Errors errors = compare(solved, run_);
    for (double& error : errors) error /= 1 - kCompanionToleranceRatio;
    // All later companions use this tolerance, so that solver errors do not count as errors of steps or mesh.
    scene_ = std::move(companion);
    run_ = std::move(solved);
    return errors;
  }

  Errors measure_mesh_error() {
    if (!can_refine(scene_, 0.5)) throw Error(ExitCode::usage, "the cells cannot be halved");
    const auto coarse = [&](double refinement) {
      scene::Scene companion = scene_;
      refine(companion, refinement);
      return companion;
    };
    const scene::Scene half = coarse(0.5);
    const Trajectory halved = follow(half);
    const std::vector<std::size_t> same = matching_particles_in_refined(half);
    const Change change{2, compare(halved, run_, same)};
    const bool few = std::any_of(scene_.cloths.begin(), scene_.cloths.end(), [](const scene::Cloth& cloth) {
      return std::min(cloth.particles_weft, cloth.particles_warp) - 1 < 4 * kMinCellsForOrder;
    });
    if (few || !can_refine(scene_, 0.25)) return richardson(kMeshOrder, change, std::nullopt);
    const scene::Scene quarter = coarse(0.25);
    std::vector<std::size_t> same_again = matching_particles_in_refined(quarter);
    for (std::size_t& particle : same_again) particle = same[particle];
    return richardson(kMeshOrder, change, Change{4, compare(follow(quarter), run_, same_again)});
  }

  Errors measure_start_error() {
    scene::Scene companion = scene_;
    for (scene::Cloth& cloth : companion.cloths) cloth.start_noise += kStartDisplacement;
    return difference(companion);
  }

  scene::Scene scene_;
  Trajectory run_;  // run of `scene_`, with which companions are compared
  const CompanionOptions& options_;
  ErrorEstimate result_;
};

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::string_view kNames[kErrorSources] = {"time steps", "solver", "mesh", "start"};
  return kNames[static_cast<std::size_t>(source)];
}

bool ErrorEstimate::is_lower_bound() const {
  return is_chaotic || steps_irregular ||
         std::ranges::any_of(parts, [](const ErrorPart& part) { return !part.missing.empty(); });
}

const ErrorPart& ErrorEstimate::largest() const {
  return *std::ranges::max_element(parts, {},
                                   [](const ErrorPart& part) { return at(part.errors, Quantity::position); });
}

ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options) {
  if (scene.cloths.empty())
    throw Error(ExitCode::usage, "the scene has no cloth or rope, whose error could be estimated");
  return Companions(scene, std::move(run), options).estimate();
}

}  // namespace weft::run_error
