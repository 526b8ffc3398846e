#include "bench/accuracy_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/plot.hpp"

namespace weft::bench {
namespace {

using scene::Integrator;
constexpr Axis kAxesInOrder[kAxes] = {Axis::step,   Axis::scene_step, Axis::tolerance,
                                      Axis::newton, Axis::linear,     Axis::mesh};

// Where nothing touches, single numbers of the end say nothing that the motion does not.
std::vector<Quantity> quantities_of(const Accuracy& accuracy) {
  std::vector<Quantity> quantities{Quantity::position, Quantity::velocity, Quantity::energy};
  if (accuracy.contact)
    for (Quantity q : {Quantity::shadow, Quantity::top, Quantity::rest_energy, Quantity::centre})
      quantities.push_back(q);
  return quantities;
}

std::string_view axis_name(Axis axis) {
  constexpr std::string_view kNames[kAxes] = {"step", "scene_step", "tolerance", "newton", "linear", "mesh"};
  return kNames[static_cast<std::size_t>(axis)];
}

// Exponent between this run and the one before it in its series; nothing where one of the two tells none.
std::string observed_order(const Accuracy& accuracy, const Run* before, const Run& run, Quantity quantity) {
  if (before == nullptr || before->failed() || run.failed()) return {};
  const double coarse = error_of(*before, quantity), fine = error_of(run, quantity);
  if (!(coarse > 0 && fine > 0) || !accuracy.resolved(run, quantity)) return {};
  return fmt::format(" ({:.2f})", std::log(coarse / fine) / std::log(control_of(*before) / control_of(run)));
}

std::string control_text(const Run& run) {
  if (run.axis == Axis::mesh) return fmt::format("{:g} × cells, {} particles", run.setting.refinement, run.particles);
  if (run.axis == Axis::step || run.axis == Axis::scene_step) return fmt::format("{:.4g} ms", 1e3 * run.setting.step);
  return fmt::format("{:.3g}{}", control_of(run), run.axis == Axis::tolerance ? " m" : "");
}

// The runs of one axis, each error followed by the order observed since the row above.
Table axis_table(const Accuracy& accuracy, Axis axis, const std::string& control) {
  const auto quantities = quantities_of(accuracy);
  Table table{
      {"integrator", control, "steps", "rejected", "Newton a step", "linear a step", "CPU s", "expected order"}};
  for (Quantity q : quantities) table[0].push_back(fmt::format("{} [{}]", name_of(q), unit_of(q)));
  for (Integrator integrator : kIntegrators) {
    const Run* before = nullptr;
    for (const Run* run : accuracy.series(axis, integrator)) {
      const double steps = std::max(1, run->steps);
      std::vector<std::string> row{std::string(name_of(integrator)),
                                   control_text(*run),
                                   std::to_string(run->steps),
                                   std::to_string(run->rejected_steps),
                                   fmt::format("{:.1f}", run->newton_iterations / steps),
                                   fmt::format("{:.0f}", run->linear_iterations / steps),
                                   fmt::format("{:.2g}", run->cpu_s),
                                   fmt::format("{:.2g}", expected_order(*run))};
      if (run->failed()) row.push_back(run->failure);
      for (std::size_t i = 0; !run->failed() && i < quantities.size(); ++i)
        row.push_back(fmt::format("{}{:.1e}{}", accuracy.resolved(*run, quantities[i]) ? "" : "~",
                                  error_of(*run, quantities[i]),
                                  observed_order(accuracy, before, *run, quantities[i])));
      row.resize(table[0].size());
      table.push_back(std::move(row));
      before = run;
    }
  }
  return table;
}

struct Style {
  const char *name, *color;
};
Style style_of(Integrator integrator) {
  // Told apart in print and with red-green blindness (palette of Okabe and Ito).
  switch (integrator) {
    case Integrator::implicit_euler:
      return {"Euler", "#d55e00"};
    case Integrator::implicit_midpoint:
      return {"midpoint", "#0072b2"};
    case Integrator::bdf2:
      return {"BDF2", "#009e73"};
  }
  return {"", "black"};
}

// One curve for each integrator that has runs on the axis.
template <class Across>
void add_curves(Panel& panel, const Accuracy& accuracy, Axis axis, Quantity quantity, const char* kind, Marker marker,
                bool dashed, const Across& across) {
  for (Integrator integrator : kIntegrators) {
    const Style style = style_of(integrator);
    Curve curve{fmt::format("{}, {}", style.name, kind), style.color, marker, dashed, {}};
    for (const Run* run : accuracy.series(axis, integrator))
      if (!run->failed()) curve.points.emplace_back(across(*run), error_of(*run, quantity));
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
}

double cpu_of(const Run& run) {
  return run.cpu_s;
}

std::string error_label(Quantity quantity) {
  const std::string unit(unit_of(quantity));
  return fmt::format("error of the {} [{}]", name_of(quantity), unit == "1" ? "share" : unit);
}

std::string uncertainty_table(const Accuracy& accuracy) {
  Table table{{"quantity", "uncertainty of the reference", "marked ~ up to"}};
  for (Quantity q : quantities_of(accuracy)) {
    const double uncertainty = accuracy.uncertainty[static_cast<std::size_t>(q)];
    table.push_back({fmt::format("{} [{}]", name_of(q), unit_of(q)), fmt::format("{:.1e}", uncertainty),
                     fmt::format("{:.1e}", 10 * uncertainty)});
  }
  return markdown(table);
}

}  // namespace

Table accuracy_table(const Accuracy& accuracy) {
  Table table{{"axis", "integrator", "step_s", "tolerance_m", "newton_tolerance", "linear_tolerance", "refinement",
               "particles", "steps", "rejected_steps", "newton_iterations", "linear_iterations", "cpu_s",
               "expected_order"}};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const auto quantity = static_cast<Quantity>(q);
    table[0].push_back(fmt::format("{} [{}]", name_of(quantity), unit_of(quantity)));
    table[0].push_back(fmt::format("{} resolved", name_of(quantity)));
  }
  table[0].push_back("failure");
  for (const Run& run : accuracy.runs) {
    const Setting& s = run.setting;
    std::vector<std::string> row{std::string(axis_name(run.axis)),
                                 std::string(name_of(s.integrator)),
                                 s.tolerance ? "" : fmt::format("{:g}", s.step),
                                 s.tolerance ? fmt::format("{:.3g}", *s.tolerance) : "",
                                 fmt::format("{:g}", s.newton_tolerance),
                                 fmt::format("{:g}", s.linear_tolerance),
                                 fmt::format("{:g}", s.refinement),
                                 std::to_string(run.particles),
                                 std::to_string(run.steps),
                                 std::to_string(run.rejected_steps),
                                 std::to_string(run.newton_iterations),
                                 std::to_string(run.linear_iterations),
                                 fmt::format("{:.4g}", run.cpu_s),
                                 fmt::format("{:.3g}", expected_order(run))};
    for (std::size_t q = 0; q < kQuantities; ++q) {
      const auto quantity = static_cast<Quantity>(q);
      row.push_back(run.failed() ? "" : fmt::format("{:.4g}", error_of(run, quantity)));
      row.push_back(run.failed() ? "" : accuracy.resolved(run, quantity) ? "yes" : "no");
    }
    row.push_back(run.failure);
    table.push_back(std::move(row));
  }
  return table;
}

std::string work_svg(const std::string& title, const Accuracy& accuracy) {
  std::vector<Panel> panels;
  for (Quantity q : quantities_of(accuracy)) {
    Panel panel{fmt::format("{}: {}", title, name_of(q)), "CPU time [s]", error_label(q), {}, {}};
    panel.unresolved_below = 10 * accuracy.uncertainty[static_cast<std::size_t>(q)];
    add_curves(panel, accuracy, Axis::step, q, "exact", Marker::circle, false, cpu_of);
    add_curves(panel, accuracy, Axis::scene_step, q, "scene's", Marker::square, true, cpu_of);
    add_curves(panel, accuracy, Axis::tolerance, q, "tolerance", Marker::triangle, false, cpu_of);
    panels.push_back(std::move(panel));
  }
  return log_log_svg(panels);
}

std::string settings_svg(const std::string& title, const Accuracy& accuracy) {
  const Quantity q = deciding_quantity(accuracy);
  const auto milliseconds = [](const Run& run) { return 1e3 * run.setting.step; };
  Panel steps{title + ": fixed steps", "step [ms]", error_label(q), {}, {}};
  steps.unresolved_below = 10 * accuracy.uncertainty[static_cast<std::size_t>(q)];
  add_curves(steps, accuracy, Axis::step, q, "exact", Marker::circle, false, milliseconds);
  add_curves(steps, accuracy, Axis::scene_step, q, "scene's", Marker::square, true, milliseconds);
  Panel solver{title + ": what the solver leaves", "CPU time [s]", error_label(q), {}, {}};
  add_curves(solver, accuracy, Axis::newton, q, "Newton", Marker::circle, false, cpu_of);
  add_curves(solver, accuracy, Axis::linear, q, "linear", Marker::square, true, cpu_of);
  Panel meshes{title + ": difference to half the spacing", "CPU time [s]", "difference [m, or share]", {}, {}};
  std::size_t color = 0;
  for (Quantity of : {Quantity::position, Quantity::energy, Quantity::shadow, Quantity::centre}) {
    Curve curve{std::string(name_of(of)), style_of(kIntegrators[color % 3]).color, Marker::circle, color == 3, {}};
    for (const Run& run : accuracy.runs)
      if (run.axis == Axis::mesh && !run.failed()) curve.points.emplace_back(run.cpu_s, error_of(run, of));
    meshes.curves.push_back(std::move(curve));
    ++color;
  }
  return log_log_svg({steps, solver, meshes});
}

std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot) {
  constexpr const char* kHeadings[kAxes] = {
      "Fixed steps, solved so exactly that the step decides",
      "Fixed steps, with the solver settings of the scene",
      "Steps chosen by time.tolerance",
      "What Newton's tolerance leaves: error against the exactly solved run with the scene's step",
      "What the tolerance of the linear solver leaves, with newton_tolerance 0.01",
      "Meshes: difference to the mesh with twice the cells along each side",
  };
  constexpr const char* kControls[kAxes] = {"step", "step", "tolerance", "newton_tolerance", "linear_tolerance",
                                            "mesh"};
  std::string text = fmt::format(
      "# Error against run time: {}\n\n{}\n![Errors against CPU time]({})\n\n![Steps, solver and mesh]({})\n\n"
      "{:.3g} s in {} frames. Position, velocity and energy: largest value of all frames, root of the mean square over "
      "the mass; the rest: of the last frame. Energies are in shares of the {:.3g} J in play. In parentheses the "
      "exponent observed since the row above.\n\n## The reference\n\n{}, step {:.4g} ms, newton_tolerance {:g}. Its "
      "uncertainty is {}. Errors within ten times of it are marked with ~.\n\n{}\n",
      title, conclusion(accuracy), work_plot, settings_plot, accuracy.duration, accuracy.frames,
      accuracy.largest_energy, name_of(accuracy.reference.integrator), 1e3 * accuracy.reference.step,
      accuracy.reference.newton_tolerance,
      accuracy.contact
          ? "the difference to a run with twice its step, or what a perturbation of the start by 1 or 2 µm "
            "changes at the finest step measured, whichever is more"
          : "the difference to a run with twice its step",
      uncertainty_table(accuracy));
  for (Axis axis : kAxesInOrder) {
    const auto i = static_cast<std::size_t>(axis);
    const Table table = axis_table(accuracy, axis, kControls[i]);
    if (table.size() > 1) text += fmt::format("## {}\n\n{}\n", kHeadings[i], markdown(table));
  }
  return text + "The preconditioner of the linear solver is chosen by the program; `bench_solver` compares solvers.\n";
}

}  // namespace weft::bench
