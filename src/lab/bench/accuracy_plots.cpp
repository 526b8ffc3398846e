#include <fmt/format.h>

#include <set>

#include "lab/bench/accuracy_report.hpp"
#include "lab/bench/plot.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;

struct Style {
  const char *name, *color;
};
Style style_of(Integrator integrator) {
  // Palette of Okabe and Ito: the colours also differ in grey print and for readers with red-green blindness.
  constexpr Style kStyles[] = {{"Euler", "#d55e00"}, {"midpoint", "#0072b2"}, {"BDF2", "#009e73"}};
  return kStyles[static_cast<std::size_t>(integrator)];
}

// Adds one curve for each integrator with runs.
template <class Across>
void add_curves(Panel& panel, Quantity quantity, const char* kind, Marker marker, bool dashed,
                const std::vector<const Run*>& runs, const Across& across) {
  for (Integrator integrator : kIntegrators) {
    const Style style = style_of(integrator);
    Curve curve{fmt::format("{}, {}", style.name, kind), style.color, marker, dashed, {}};
    for (const Run* run : runs)
      if (!run->failed() && run->setting.integrator == integrator)
        curve.points.emplace_back(across(*run), error_of(*run, quantity));
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
}

double cpu_of(const Run& run) {
  return run.work.cpu_s;
}

std::string error_label(Quantity quantity) {
  const std::string unit(unit_of(quantity));
  return fmt::format("error of the {} [{}]", name_of(quantity), unit == "1" ? "ratio" : unit);
}

// Adds curves of Run::solver_error over newton_tolerance, for the longest step, the scene's step and the shortest step.
void add_tolerances(Panel& panel, const Accuracy& accuracy, Integrator integrator) {
  const auto runs = accuracy.series(Axis::grid, integrator);
  if (runs.empty()) return;
  const Style style = style_of(integrator);
  const double coarsest = runs.front()->setting.step, finest = runs.back()->setting.step;
  for (double step : std::set<double>{coarsest, accuracy.of_scene.step, finest}) {
    Curve curve{fmt::format("{}, {:.3g} ms", style.name, 1e3 * step),
                style.color,
                step == coarsest ? Marker::square
                : step == finest ? Marker::triangle
                                 : Marker::circle,
                step != accuracy.of_scene.step,
                {}};
    for (const Run* run : runs)
      if (!run->failed() && run->setting.step == step)
        curve.points.emplace_back(run->setting.newton_tolerance, run->solver_error);
    panel.curves.push_back(std::move(curve));
  }
}

}  // namespace

std::string work_svg(const std::string& title, const Accuracy& accuracy) {
  std::vector<Panel> panels;
  for (Quantity q : quantities_of(accuracy)) {
    Panel panel{fmt::format("{}: {}", title, name_of(q)), "CPU time [s]", error_label(q), {}, {}};
    panel.unresolved_below = 3 * at(accuracy.uncertainty, q);
    add_curves(panel, q, "step decides", Marker::circle, false, step_limited_runs(accuracy), cpu_of);
    add_curves(panel, q, "scene's", Marker::square, true, with_solver_of_scene(accuracy), cpu_of);
    add_curves(panel, q, "tolerance", Marker::triangle, false, runs_of_axis(accuracy, Axis::tolerance), cpu_of);
    panels.push_back(std::move(panel));
  }
  return log_log_svg(panels);
}

std::string settings_svg(const std::string& title, const Accuracy& accuracy) {
  const Quantity q = deciding_quantity(accuracy);
  const auto milliseconds = [](const Run& run) { return 1e3 * run.setting.step; };
  Panel steps{title + ": fixed steps", "step [ms]", error_label(q), {}, {}};
  steps.unresolved_below = 3 * at(accuracy.uncertainty, q);
  add_curves(steps, q, "step decides", Marker::circle, false, step_limited_runs(accuracy), milliseconds);
  add_curves(steps, q, "scene's", Marker::square, true, with_solver_of_scene(accuracy), milliseconds);
  Panel solver{title + ": solver", "newton_tolerance", fmt::format("left by the solver [{}]", unit_of(q)), {}, {}};
  for (Integrator integrator : kIntegrators) add_tolerances(solver, accuracy, integrator);
  Panel meshes{title + ": difference to half the spacing", "CPU time [s]", "difference [m, or relative]", {}, {}};
  std::size_t color = 0;
  for (Quantity of : {q, Quantity::energy, Quantity::drift}) {
    Curve curve{std::string(name_of(of)), style_of(kIntegrators[color++]).color, Marker::circle, false, {}};
    for (const Run* run : runs_of_axis(accuracy, Axis::mesh))
      if (!run->failed()) curve.points.emplace_back(run->work.cpu_s, error_of(*run, of));
    if (!curve.points.empty()) meshes.curves.push_back(std::move(curve));
  }
  return log_log_svg({steps, solver, meshes});
}

}  // namespace weft::bench
