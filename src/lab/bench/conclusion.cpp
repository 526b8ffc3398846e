// Conclusions from the runs of accuracy.hpp, as sentences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "lab/bench/accuracy_report.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

// Target of recommendation(), relative to the cloth's size.
constexpr double kTargetErrorRatio = 0.01;
// CPU times or errors within this ratio count as equal.
constexpr double kEqualRatio = 1.1;
// Target errors of conclusion() [m].
constexpr double kTargets[] = {1e-2, 1e-3, 1e-4};
// A target can be verified if the uncertainty of the reference is at most this fraction of the target.
constexpr double kMaxUncertaintyRatio = 0.3;
// If all errors are below this value, nothing moves [m].
constexpr double kNegligibleMotion = 1e-12;
// cost_of_a_digit() is fitted to at most this number of runs of a series, the finest ones.
constexpr std::size_t kMaxFittedRuns = 4;

bool is_candidate(const Run& run) {
  return !run.failed() && (run.axis == Axis::grid || run.axis == Axis::tolerance);
}

// Whether `a` is finer than `b`: both have the same axis and integrator, and `a` has a smaller time.tolerance or, with
// fixed steps, a smaller step or newton_tolerance, while neither is larger.
bool is_finer(const Run& a, const Run& b) {
  if (a.axis != b.axis || a.setting.integrator != b.setting.integrator) return false;
  if (a.axis == Axis::tolerance) return a.setting.tolerance < b.setting.tolerance;
  return a.setting.step <= b.setting.step && a.setting.newton_tolerance <= b.setting.newton_tolerance &&
         (a.setting.step < b.setting.step || a.setting.newton_tolerance < b.setting.newton_tolerance);
}

// Upper bound of the error: error plus uncertainty.
double bound_of(const Accuracy& accuracy, const Run& run, Quantity quantity) {
  return error_of(run, quantity) + accuracy.uncertainty_of(run, quantity);
}

// Whether the run and all finer runs (see is_finer()) certainly reach the target.
bool certainly_reaches(const Accuracy& accuracy, const Run& run, Quantity quantity, double target) {
  const auto reaches = [&](const Run& r) { return bound_of(accuracy, r, quantity) <= target; };
  return is_candidate(run) && reaches(run) && std::ranges::all_of(accuracy.runs, [&](const Run& other) {
           return other.failed() || !is_finer(other, run) || reaches(other);
         });
}

// The step rounded up to four significant digits [s]. With a step rounded down, a frame would need one more step.
double shown_step(double step) {
  const double scale = std::pow(10, 3 - std::floor(std::log10(step)));
  return std::ceil(step * scale - 1e-6) / scale;
}

// The setting in the syntax of scene files.
std::string keys_text(const Setting& s) {
  return fmt::format("`time.integrator = \"{}\"`, `{}`, `solver.newton_tolerance = {:.3g}`", name_of(s.integrator),
                     s.tolerance ? fmt::format("time.tolerance = {:.3g}", *s.tolerance)
                                 : fmt::format("time.step = {:.4g}", shown_step(s.step)),
                     s.newton_tolerance);
}

std::string deviation_text(const Accuracy& accuracy, const Run& run, Quantity quantity) {
  return fmt::format("{:.2g} CPU s, the {} off by at most {:.2g} mm{}", run.work.cpu_s, name_of(quantity),
                     1e3 * bound_of(accuracy, run, quantity), quantity == Quantity::centre ? " in the last frame" : "");
}

std::string scene_setting_text(const Accuracy& accuracy, const Run* scene_run, Quantity quantity) {
  if (scene_run == nullptr) return "the settings of the scene were not measured, or do not reach its end";
  return fmt::format("the settings of the scene take {}", deviation_text(accuracy, *scene_run, quantity));
}

std::string cheapest_text(const Accuracy& accuracy, Quantity quantity, double target) {
  const Run* best = cheapest(accuracy, quantity, target);
  if (best == nullptr) return "no run is known to be as exact";
  const Setting& s = best->setting;
  const std::string steps =
      s.tolerance ? fmt::format("tolerance {:.3g} m", *s.tolerance)
                  : fmt::format("step {:.4g} ms, newton_tolerance {:.1g}", 1e3 * s.step, s.newton_tolerance);
  return fmt::format("{}, {} ({:.2g} CPU s, error {:.1e} m)", name_of(s.integrator), steps, best->work.cpu_s,
                     error_of(*best, quantity));
}

std::string cheapest_settings_text(const Accuracy& accuracy, Quantity quantity) {
  const double uncertainty = at(accuracy.uncertainty, quantity);
  std::string text;
  for (double target : kTargets) {
    const std::string choice = uncertainty > kMaxUncertaintyRatio * target ? "the reference is not known so exactly"
                                                                           : cheapest_text(accuracy, quantity, target);
    text += fmt::format("{}{} m: {}", text.empty() ? "" : "; ", target, choice);
  }
  // Add the smallest target that the reference can verify.
  if (uncertainty > kMaxUncertaintyRatio * kTargets[2]) {
    const double known = uncertainty / kMaxUncertaintyRatio;
    text += fmt::format("; {:.1e} m, as exact as this report can show: {}", known,
                        cheapest_text(accuracy, quantity, known));
  }
  return fmt::format("Cheapest for an error of the {} of {}.", name_of(quantity), text);
}

/// Least-squares line through log10(CPU time) over log10(error).
class Line {
 public:
  void add(const Run& run, Quantity quantity) {
    const double x = std::log10(error_of(run, quantity)), y = std::log10(run.work.cpu_s);
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    ++n_, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y;
  }
  // Factor by which the CPU time grows for a tenth of the error, as text, such as "3.6 times"; "unknown" if the points
  // determine no falling line.
  std::string cost_of_a_digit() const {
    const double spread = n_ * xx_ - x_ * x_, slope = (n_ * xy_ - x_ * y_) / spread;
    if (n_ < 2 || !(spread > 1e-3) || !(slope < 0)) return "unknown";
    return slope < -1.5 ? std::string("more than 30 times") : fmt::format("{:.1f} times", std::pow(10, -slope));
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

// Line::cost_of_a_digit() of the finest runs of a series whose errors are resolved (Accuracy::resolved()).
std::string digit_of_series(const Accuracy& accuracy, const std::vector<const Run*>& series, Quantity quantity) {
  Line line;
  std::size_t used = 0;
  for (auto run = series.rbegin(); run != series.rend() && used < kMaxFittedRuns; ++run) {
    if ((*run)->failed() || !accuracy.resolved(**run, quantity)) continue;
    line.add(**run, quantity);
    ++used;
  }
  return line.cost_of_a_digit();
}

std::string cost_of_a_digit(const Accuracy& accuracy, Quantity quantity) {
  Line line;
  for (const Run* run : pareto_front(accuracy, quantity))
    if (accuracy.resolved(*run, quantity)) line.add(*run, quantity);
  std::string each;
  for (Integrator integrator : kIntegrators) {
    if (accuracy.series(Axis::grid, integrator).empty() && accuracy.series(Axis::tolerance, integrator).empty())
      continue;
    each += fmt::format("{}{} {} and {}", each.empty() ? "" : ", ", name_of(integrator),
                        digit_of_series(accuracy, accuracy.step_limited_runs(integrator), quantity),
                        digit_of_series(accuracy, accuracy.series(Axis::tolerance, integrator), quantity));
  }
  return fmt::format(
      "The CPU time for one more digit, along the cheapest settings: {} (by integrator, steps that decide and "
      "tolerances: "
      "{}).",
      line.cost_of_a_digit(), each);
}

// Errors due to step, solver and mesh with the settings of the scene. If the scene has time.tolerance, the error due to
// the step includes that due to the solver.
std::string error_parts_text(const Accuracy& accuracy, Quantity quantity) {
  std::map<std::string, double> left;
  for (const Run& run : accuracy.runs) {
    if (run.failed()) continue;
    if (run.axis == Axis::mesh && run.setting.refinement == 1) left["the mesh"] = error_of(run, quantity);
    if (accuracy.of_scene.tolerance) {
      if (&run == accuracy.scene_setting_run())
        left["the step"] = error_of(run, quantity);  // includes the error due to the solver
      continue;
    }
    if (run.axis != Axis::grid || run.setting.integrator != accuracy.of_scene.integrator ||
        run.setting.step != accuracy.of_scene.step)
      continue;
    if (run.setting.newton_tolerance == accuracy.of_scene.newton_tolerance && std::isfinite(run.solver_error))
      left["the solver"] = run.solver_error;
    if (run.is_step_limited) left["the step"] = error_of(run, quantity);
  }
  const auto text = [&](const char* source) {
    const auto found = left.find(source);
    return found == left.end() ? fmt::format("{} is not known", source)
                               : fmt::format("{} {:.1e} m", source, found->second);
  };
  const auto largest =
      std::max_element(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return fmt::format(
      "As the scene stands ({}, {}, newton_tolerance {:g}) {}, {}, {} (difference to twice the cells): {}.",
      name_of(accuracy.of_scene.integrator),
      accuracy.of_scene.tolerance ? fmt::format("tolerance {:.3g} m", *accuracy.of_scene.tolerance)
                                  : fmt::format("{:.4g} ms", 1e3 * accuracy.of_scene.step),
      accuracy.of_scene.newton_tolerance, "are left by " + text("the step"), text("the solver"), text("the mesh"),
      largest == left.end() ? std::string("none is known") : fmt::format("the largest is due to {}", largest->first));
}

bool is_still(const Accuracy& accuracy) {
  const Quantity quantity = deciding_quantity(accuracy);
  return std::ranges::all_of(accuracy.runs, [&](const Run& run) {
    return run.failed() || bound_of(accuracy, run, quantity) < kNegligibleMotion;
  });
}

}  // namespace

const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target) {
  const Run* best = nullptr;
  for (const Run& run : accuracy.runs)
    if ((best == nullptr || run.work.cpu_s < best->work.cpu_s) && certainly_reaches(accuracy, run, quantity, target))
      best = &run;
  return best;
}

std::vector<const Run*> pareto_front(const Accuracy& accuracy, Quantity quantity) {
  std::vector<const Run*> by_time, front;
  for (const Run& run : accuracy.runs)
    if (is_candidate(run)) by_time.push_back(&run);
  std::stable_sort(by_time.begin(), by_time.end(),
                   [](const Run* a, const Run* b) { return a->work.cpu_s < b->work.cpu_s; });
  double least = std::numeric_limits<double>::infinity();
  for (const Run* run : by_time) {
    if (bound_of(accuracy, *run, quantity) >= least) continue;
    least = bound_of(accuracy, *run, quantity);
    front.push_back(run);
  }
  return front;
}

namespace {

// Of the runs that reach the target in at most kEqualRatio times `cpu_s`, the one with the smallest bound_of(). Bounds
// of runs without the scene's own newton_tolerance count as kEqualRatio times as large, to prefer the scene's own.
const Run* most_exact_at_cost(const Accuracy& accuracy, Quantity quantity, double target, double cpu_s) {
  const Run* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Run& run : accuracy.runs) {
    if (run.work.cpu_s > kEqualRatio * cpu_s || !certainly_reaches(accuracy, run, quantity, target)) continue;
    const bool is_same_solver = run.setting.newton_tolerance == accuracy.of_scene.newton_tolerance;
    const double error = bound_of(accuracy, run, quantity) * (is_same_solver ? 1 : kEqualRatio);
    if (error < least) best = &run, least = error;
  }
  return best;
}

}  // namespace

std::string recommendation(const Accuracy& accuracy) {
  const Quantity quantity = deciding_quantity(accuracy);
  if (is_still(accuracy)) return "Nothing moves: there is no error to measure.";
  const double target = kTargetErrorRatio * accuracy.cloth_size;
  const std::string wanted = fmt::format("{:.2g} mm (1 % of the cloth's size)", 1e3 * target);
  const Run* best = cheapest(accuracy, quantity, target);
  const Run* scene_run = accuracy.scene_setting_run();
  if (best == nullptr) {
    const auto exact = pareto_front(accuracy, quantity);
    if (exact.empty()) return "No setting that was tried reaches the end of the scene.";
    const bool reaches = bound_of(accuracy, *exact.back(), quantity) <= target;
    return fmt::format(
        "No setting that was tried is known to keep the {} within {}. The most exact one is {}: {}{}; {}.",
        name_of(quantity), wanted, keys_text(exact.back()->setting), deviation_text(accuracy, *exact.back(), quantity),
        reaches ? ", which may be chance, as runs that are solved more exactly are farther off" : "",
        scene_setting_text(accuracy, scene_run, quantity));
  }
  best = most_exact_at_cost(accuracy, quantity, target, best->work.cpu_s);
  if (scene_run != nullptr && scene_run->work.cpu_s <= kEqualRatio * best->work.cpu_s &&
      certainly_reaches(accuracy, *scene_run, quantity, target))
    return fmt::format(
        "Keep the settings of the scene, {}: {}, for an accuracy of {}. No other takes less than {:.2g} CPU s.",
        keys_text(scene_run->setting), deviation_text(accuracy, *scene_run, quantity), wanted,
        std::min(scene_run->work.cpu_s, best->work.cpu_s));
  return fmt::format("Use {}: {}, for an accuracy of {}; {}.", keys_text(best->setting),
                     deviation_text(accuracy, *best, quantity), wanted,
                     scene_setting_text(accuracy, scene_run, quantity));
}

std::string conclusion(const Accuracy& accuracy) {
  const Quantity quantity = deciding_quantity(accuracy);
  if (is_still(accuracy)) return "";
  return cheapest_settings_text(accuracy, quantity) + " " + cost_of_a_digit(accuracy, quantity) + " " +
         error_parts_text(accuracy, quantity) + "\n";
}

}  // namespace weft::bench
