// What follows from the runs of bench/accuracy, in words.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "bench/accuracy_report.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

// Accuracies asked for [m].
constexpr double kTargets[] = {1e-2, 1e-3, 1e-4};
// Runs of a series, from the finest on, through which the cost of a digit is drawn.
constexpr std::size_t kLast = 4;
const double kShipped = scene::Solver{}.newton_tolerance;

bool in_the_race(const Run& run) {
  return !run.failed() && (run.axis == Axis::step || run.axis == Axis::scene_step || run.axis == Axis::tolerance);
}

std::string setting_text(const Run& run) {
  const Setting& s = run.setting;
  const std::string steps =
      s.tolerance ? fmt::format("tolerance {:.1g} m", *s.tolerance)
                  : fmt::format("step {:.3g} ms, newton_tolerance {:.1g}", 1e3 * s.step, s.newton_tolerance);
  return fmt::format("{}, {} ({:.2g} CPU s)", name_of(s.integrator), steps, run.cpu_s);
}

const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target) {
  const Run* best = nullptr;
  for (const Run& run : accuracy.runs)
    if (in_the_race(run) && error_of(run, quantity) <= target && (best == nullptr || run.cpu_s < best->cpu_s))
      best = &run;
  return best;
}

std::string which_setting(const Accuracy& accuracy, Quantity quantity) {
  const double uncertainty = accuracy.uncertainty[static_cast<std::size_t>(quantity)];
  std::string text;
  for (double target : kTargets) {
    std::string choice = "no run is as exact";
    if (const Run* best = cheapest(accuracy, quantity, target)) choice = setting_text(*best);
    if (uncertainty > 0.3 * target) choice = "the reference is not known so exactly";
    text += fmt::format("{}{} m: {}", text.empty() ? "" : "; ", target, choice);
  }
  // What a run can be told to be right to at all: with contact, what a micrometre at the start decides.
  const Run* best = cheapest(accuracy, quantity, uncertainty);
  if (uncertainty > 0.3 * kTargets[2] && best != nullptr)
    text += fmt::format("; as exact as the scene itself, {:.1e} m: {}", uncertainty, setting_text(*best));
  return fmt::format("Cheapest for an error of the {} of {}.", name_of(quantity), text);
}

/// CPU time against error, both as decimal logarithms, as a straight line by least squares.
class Line {
 public:
  void add(const Run& run, Quantity quantity) {
    const double x = std::log10(error_of(run, quantity)), y = std::log10(run.cpu_s);
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    ++n_, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y;
  }
  // Factor in CPU time for a tenth of the error: "3.6 times", or empty where the line does not tell.
  std::string cost_of_a_digit() const {
    const double spread = n_ * xx_ - x_ * x_, slope = (n_ * xy_ - x_ * y_) / spread;
    if (n_ < 2 || !(spread > 1e-3) || !(slope < 0)) return "";
    return slope < -1.5 ? std::string("more than 30 times") : fmt::format("{:.1f} times", std::pow(10, -slope));
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

// Of the finest runs of a series that are resolved.
std::string digit_of_series(const Accuracy& accuracy, Axis axis, Integrator integrator, Quantity quantity) {
  const auto series = accuracy.series(axis, integrator);
  Line line;
  std::size_t used = 0;
  for (auto run = series.rbegin(); run != series.rend() && used < kLast; ++run) {
    if ((*run)->failed() || !accuracy.resolved(**run, quantity)) continue;
    line.add(**run, quantity);
    ++used;
  }
  return line.cost_of_a_digit();
}

std::string cost_of_a_digit(const Accuracy& accuracy, Quantity quantity) {
  // Runs than which none is both cheaper and more exact.
  std::map<double, const Run*> by_time;
  for (const Run& run : accuracy.runs)
    if (in_the_race(run)) by_time.emplace(run.cpu_s, &run);
  Line front;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [time, run] : by_time) {
    if (error_of(*run, quantity) >= least || !accuracy.resolved(*run, quantity)) continue;
    least = error_of(*run, quantity);
    front.add(*run, quantity);
  }
  const auto or_unknown = [](const std::string& cost) { return cost.empty() ? std::string("unknown") : cost; };
  std::string each;
  bool any = false;
  for (Integrator integrator : {Integrator::implicit_euler, Integrator::implicit_midpoint, Integrator::bdf2}) {
    const std::string by_step = digit_of_series(accuracy, Axis::step, integrator, quantity),
                      by_tolerance = digit_of_series(accuracy, Axis::tolerance, integrator, quantity);
    any = any || !by_step.empty() || !by_tolerance.empty();
    each += fmt::format("{}{} {} and {}", each.empty() ? "" : ", ", name_of(integrator), or_unknown(by_step),
                        or_unknown(by_tolerance));
  }
  const std::string cheapest = front.cost_of_a_digit();
  if (cheapest.empty() && !any)
    return "What one more digit costs is not known: too few runs differ from the reference.";
  return fmt::format(
      "The CPU time for one more digit, along the cheapest settings: {} (by integrator, exactly solved steps and "
      "tolerances: {}).",
      or_unknown(cheapest), each);
}

std::string what_is_left(const Accuracy& accuracy, Quantity quantity) {
  std::string solver = "is not known";
  for (const Run& run : accuracy.runs) {
    if (run.axis != Axis::newton || run.failed() || run.setting.newton_tolerance != kShipped) continue;
    solver = fmt::format("leaves {:.1e} m ({}, step {:.3g} ms)", error_of(run, quantity),
                         name_of(run.setting.integrator), 1e3 * run.setting.step);
  }
  std::string mesh = "is not known";
  for (const Run& run : accuracy.runs)
    if (run.axis == Axis::mesh && !run.failed() && run.setting.refinement == 1)
      mesh = fmt::format("is {:.1e} m", error_of(run, quantity));
  return fmt::format(
      "Besides the steps, Newton's method with fixed steps and newton_tolerance {} {}, and the difference to a mesh "
      "twice as fine {}: steps more exact than these two buy nothing.",
      kShipped, solver, mesh);
}

}  // namespace

std::string conclusion(const Accuracy& accuracy) {
  const Quantity quantity = deciding_quantity(accuracy);
  return which_setting(accuracy, quantity) + " " + cost_of_a_digit(accuracy, quantity) + " " +
         what_is_left(accuracy, quantity) + "\n";
}

}  // namespace weft::bench
