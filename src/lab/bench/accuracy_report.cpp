#include "lab/bench/accuracy_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace weft::bench {
namespace {

using scene::Integrator;

std::string_view axis_name(Axis axis) {
  constexpr std::string_view kNames[kAxes] = {"grid", "tolerance", "linear", "mesh"};
  return kNames[static_cast<std::size_t>(axis)];
}

std::string label(Quantity quantity) {
  return fmt::format("{} [{}]", name_of(quantity), unit_of(quantity));
}

// Order of the error, observed between this run and the run before in its series; empty if it cannot be determined.
std::string observed_order(const Accuracy& accuracy, const Run* before, const Run& run, Quantity quantity) {
  if (before == nullptr || before->failed() || control_of(*before) == control_of(run)) return {};
  const double coarse = error_of(*before, quantity), fine = error_of(run, quantity);
  if (!(coarse > 0 && fine > 0) || !accuracy.resolved(run, quantity)) return {};
  return fmt::format(" ({:.2f})", std::log(coarse / fine) / std::log(control_of(*before) / control_of(run)));
}

std::string control_text(const Run& run) {
  const Setting& s = run.setting;
  if (run.axis == Axis::mesh) return fmt::format("{:g} × cells, {} particles", s.refinement, run.particles);
  if (run.axis == Axis::grid)
    return fmt::format("{:.4g} ms, newton_tolerance {:.1g}", 1e3 * s.step, s.newton_tolerance);
  return fmt::format("{} {:.3g}{}", axis_name(run.axis), control_of(run), run.axis == Axis::tolerance ? " m" : "");
}

std::string error_text(const Accuracy& accuracy, const Run& run, Quantity quantity) {
  return fmt::format("{}{:.1e}", accuracy.resolved(run, quantity) ? "" : "~", error_of(run, quantity));
}

// One row per run. With `with_orders`, each error is followed by the order observed between the row above and this row.
Table runs_table(const Accuracy& accuracy, const std::vector<const Run*>& runs, bool with_orders) {
  const auto quantities = quantities_of(accuracy);
  Table table{{"integrator", "setting", "steps", "rejected", "Newton a step", "linear a step", "CPU s"}};
  if (with_orders) table[0].push_back("expected order");
  for (Quantity q : quantities) table[0].push_back(label(q));
  const Run* before = nullptr;
  for (const Run* run : runs) {
    if (before != nullptr && before->setting.integrator != run->setting.integrator) before = nullptr;
    const double steps = std::max(1, run->work.steps);
    std::vector<std::string> row{std::string(name_of(run->setting.integrator)),
                                 control_text(*run),
                                 std::to_string(run->work.steps),
                                 std::to_string(run->work.rejected_steps),
                                 fmt::format("{:.1f}", run->work.newton_iterations / steps),
                                 fmt::format("{:.0f}", run->work.linear_iterations / steps),
                                 fmt::format("{:.2g}", run->work.cpu_s)};
    if (with_orders) row.push_back(fmt::format("{:.2g}", expected_order(*run)));
    for (std::size_t i = 0; !run->failed() && i < quantities.size(); ++i)
      row.push_back(error_text(accuracy, *run, quantities[i]) +
                    (with_orders ? observed_order(accuracy, before, *run, quantities[i]) : ""));
    row.resize(table[0].size(), "failed");
    table.push_back(std::move(row));
    before = run;
  }
  return table;
}

// Errors and CPU times: one row per step, one column per newton_tolerance. * marks runs with Run::is_step_limited.
Table grid_table(const Accuracy& accuracy, Integrator integrator) {
  const auto runs = accuracy.series(Axis::grid, integrator);
  std::set<double, std::greater<>> steps, tolerances;
  for (const Run* run : runs) steps.insert(run->setting.step), tolerances.insert(run->setting.newton_tolerance);
  Table table{{fmt::format("{}, step", name_of(integrator))}};
  for (double tolerance : tolerances) table[0].push_back(fmt::format("{:.1g}", tolerance));
  for (double step : steps) {
    std::vector<std::string> row{fmt::format("{:.4g} ms", 1e3 * step)};
    for (double tolerance : tolerances) {
      const auto found = std::find_if(runs.begin(), runs.end(), [&](const Run* run) {
        return run->setting.step == step && run->setting.newton_tolerance == tolerance;
      });
      if (found == runs.end()) {
        row.emplace_back();
      } else if ((*found)->failed()) {
        row.emplace_back("failed");
      } else {
        row.push_back(fmt::format("{}{} ({:.2g} s)", error_text(accuracy, **found, deciding_quantity(accuracy)),
                                  (*found)->is_step_limited ? " *" : "", (*found)->work.cpu_s));
      }
    }
    table.push_back(std::move(row));
  }
  return table;
}

std::string candidate_text(const Candidate& candidate) {
  return fmt::format("{}, step {:.4g} ms, newton_tolerance {:.1g}", name_of(candidate.setting.integrator),
                     1e3 * candidate.setting.step, candidate.setting.newton_tolerance);
}

std::string cross_checks_text(const Accuracy& accuracy) {
  if (accuracy.cross_checks.empty())
    return "\nNo integrator has two runs in which the step decides: no other run checks the reference.\n";
  const Quantity q = deciding_quantity(accuracy);
  Table table{{"finest run", label(q) + " from the reference", "its own uncertainty", "excess"}};
  for (const CrossCheck& check : accuracy.cross_checks) {
    const double difference = at(check.difference, q), uncertainty = at(check.uncertainty, q);
    table.push_back({fmt::format("{}, {:.4g} ms", name_of(check.integrator), 1e3 * check.step),
                     fmt::format("{:.1e}", difference), fmt::format("{:.1e}", uncertainty),
                     difference > uncertainty ? fmt::format("{:.1e}", difference - uncertainty) : "0"});
  }
  return "\n" + markdown(table);
}

std::string reference_text(const Accuracy& accuracy) {
  const Candidate &first = accuracy.reference, &second = accuracy.second;
  const bool checked = second.failure.empty();
  const Errors of_second = second.uncertainty();
  Table table{{"quantity", "its step", "newton_tolerance × 10", "starts", "uncertainty of the second", "difference",
               "uncertainty", "errors marked ~ below"}};
  for (Quantity q : quantities_of(accuracy)) {
    std::vector<std::string> row{label(q)};
    for (const Errors* errors : {&first.step, &first.solver, &first.spread})
      row.push_back(fmt::format("{:.1e}", at(*errors, q)));
    for (const Errors* errors : {&of_second, &accuracy.difference})
      row.push_back(checked ? fmt::format("{:.1e}", at(*errors, q)) : "not known");
    row.push_back(fmt::format("{:.1e}", at(accuracy.uncertainty, q)));
    row.push_back(fmt::format("{:.1e}", 3 * at(accuracy.uncertainty, q)));
    table.push_back(std::move(row));
  }
  return fmt::format(
      "{}. The second reference, computed independently: {}{}. The more certain one is used. Its uncertainty combines "
      "the error of its step (extrapolated from twice the step, with half of the order), the change by a tenfold "
      "newton_tolerance, and the spread over starts. If the second, or the finest run of an integrator, differs by "
      "more "
      "than its own uncertainty, the excess is a lower bound of the uncertainty. Errors below three times the "
      "uncertainty plus the spread over starts are marked with ~.\n\n{}{}",
      candidate_text(first), candidate_text(second),
      checked ? "" : " (failed: " + second.failure + "; nothing checks the first)", markdown(table),
      cross_checks_text(accuracy));
}

// Distribution of the errors over the starts. Rows: the runs of Axis::grid with the
// newton_tolerance of the scene, and all runs of Axis::tolerance.
Table starts_table(const Accuracy& accuracy) {
  const Quantity q = deciding_quantity(accuracy);
  std::vector<const Run*> runs = with_solver_of_scene(accuracy);
  for (const Run* run : runs_of_axis(accuracy, Axis::tolerance)) runs.push_back(run);
  Table table{{"integrator", "setting", "least", "median", "largest", "error of the medians"}};
  for (const Run* run : runs) {
    if (run->failed() || run->start_errors.empty()) continue;
    std::vector<double> errors = run->start_errors;
    std::ranges::sort(errors);
    const std::size_t n = errors.size();
    std::vector<std::string> row{std::string(name_of(run->setting.integrator)), control_text(*run)};
    for (const double error : {errors.front(), 0.5 * (errors[(n - 1) / 2] + errors[n / 2]), errors.back()})
      row.push_back(fmt::format("{:.1e}", error));
    row.push_back(error_text(accuracy, *run, q));
    table.push_back(std::move(row));
  }
  return table;
}

std::string failures_text(const Accuracy& accuracy) {
  Table table{{"integrator", "setting", "why"}};
  for (const Run& run : accuracy.runs)
    if (run.failed()) table.push_back({std::string(name_of(run.setting.integrator)), control_text(run), run.failure});
  return table.size() > 1 ? fmt::format("## Runs that failed\n\n{}\n", markdown(table)) : std::string();
}

// The value as text; empty if it is not finite.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
}

// Run::start_errors, separated by semicolons.
std::string starts_text(const Run& run) {
  std::string text;
  for (const double error : run.start_errors) text += (text.empty() ? "" : ";") + number(error);
  return text;
}

}  // namespace

std::vector<const Run*> runs_of_axis(const Accuracy& accuracy, Axis axis) {
  std::vector<const Run*> runs;
  for (Integrator integrator : kIntegrators)
    for (const Run* run : accuracy.series(axis, integrator)) runs.push_back(run);
  return runs;
}

std::vector<const Run*> step_limited_runs(const Accuracy& accuracy) {
  std::vector<const Run*> runs;
  for (Integrator integrator : kIntegrators)
    for (const Run* run : accuracy.step_limited_runs(integrator)) runs.push_back(run);
  return runs;
}

std::vector<const Run*> with_solver_of_scene(const Accuracy& accuracy) {
  std::vector<const Run*> runs = runs_of_axis(accuracy, Axis::grid);
  std::erase_if(runs,
                [&](const Run* run) { return run->setting.newton_tolerance != accuracy.of_scene.newton_tolerance; });
  return runs;
}

Table accuracy_table(const Accuracy& accuracy) {
  Table table{{"axis", "integrator", "step_s", "tolerance_m", "newton_tolerance", "linear_tolerance", "refinement",
               "particles", "steps", "rejected_steps", "newton_iterations", "linear_iterations", "cpu_s",
               "expected_order", "step_decides", "tenfold_tighter_changes", "left_by_solver", "errors_of_starts"}};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    table[0].push_back(label(static_cast<Quantity>(q)));
    table[0].push_back(fmt::format("{} doubt", name_of(static_cast<Quantity>(q))));
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
                                 std::to_string(run.work.steps),
                                 std::to_string(run.work.rejected_steps),
                                 std::to_string(run.work.newton_iterations),
                                 std::to_string(run.work.linear_iterations),
                                 fmt::format("{:.6g}", run.work.cpu_s),
                                 fmt::format("{:.3g}", expected_order(run)),
                                 run.is_step_limited ? "yes" : "no",
                                 number(run.change),
                                 number(run.solver_error),
                                 starts_text(run)};
    for (std::size_t q = 0; q < kQuantities; ++q) {
      row.push_back(run.failed() ? "" : number(run.errors[q]));
      row.push_back(run.failed() ? "" : number(accuracy.uncertainty_of(run, static_cast<Quantity>(q))));
    }
    row.push_back(run.failure);
    table.push_back(std::move(row));
  }
  return table;
}

std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot) {
  const Quantity quantity = deciding_quantity(accuracy);
  std::string text = fmt::format(
      "# Error against run time: {}\n\n**{}**\n\n{}\n![Errors against CPU time]({})\n\n![Steps, solver and "
      "mesh]({})\n\n{:.3g} s in {} frames. {}Energies are relative to the {:.3g} J in play. In parentheses the "
      "exponent observed since the row above.\n\n## The reference\n\n{}\n## Steps and newton_tolerance\n\nError of the "
      "{} and CPU time. * marks where newton_tolerance a tenth as large changes less than a tenth of the error, or "
      "less than is known of it: the step decides.\n\n",
      title, recommendation(accuracy), conclusion(accuracy), link_to(work_plot), link_to(settings_plot),
      accuracy.duration, accuracy.frames,
      accuracy.contact
          ? fmt::format("With contact the motion is chaotic: errors are those of the medians over {} starts, "
                        "1 µm apart. Energy: largest of all frames; the rest: of the last frame. ",
                        accuracy.starts)
          : std::string("Position and velocity: root of the mean square over the mass, the largest of all "
                        "frames, as with energy; energy drift and centre of mass: of the last frame. "),
      accuracy.largest_energy, reference_text(accuracy), label(quantity));
  for (Integrator integrator : kIntegrators)
    if (!accuracy.series(Axis::grid, integrator).empty()) text += markdown(grid_table(accuracy, integrator)) + "\n";
  const auto section = [&](const char* heading, const std::vector<const Run*>& runs, bool with_orders = true) {
    if (!runs.empty()) text += fmt::format("## {}\n\n{}\n", heading, markdown(runs_table(accuracy, runs, with_orders)));
  };
  section("The front: no run is both cheaper and more exact", pareto_front(accuracy, quantity), false);
  section("Fixed steps, solved so exactly that the step decides", step_limited_runs(accuracy));
  section("Fixed steps, with the solver settings of the scene", with_solver_of_scene(accuracy));
  section("Steps chosen by time.tolerance", runs_of_axis(accuracy, Axis::tolerance));
  section("linear_tolerance, at the scene's step", runs_of_axis(accuracy, Axis::linear), false);
  section("Meshes: difference to the mesh with twice the cells along each side", runs_of_axis(accuracy, Axis::mesh));
  if (accuracy.starts > 1)
    text += fmt::format("## What the start decides\n\nError of the {} of single starts against the reference.\n\n{}\n",
                        label(quantity), markdown(starts_table(accuracy)));
  return text + failures_text(accuracy) +
         "The preconditioner of the linear solver is chosen by the program; `bench_solver` compares solvers.\n";
}

}  // namespace weft::bench
