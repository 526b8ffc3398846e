// Tables, plots and conclusions about error and CPU time of runs.
#pragma once

#include <string>
#include <vector>

#include "lab/bench/accuracy.hpp"
#include "lab/bench/report.hpp"

namespace weft::bench {

/// All runs of one axis, of all integrators.
std::vector<const Run*> runs_of_axis(const Accuracy& accuracy, Axis axis);
/// The runs of Axis::grid with Run::is_step_limited, of all integrators.
std::vector<const Run*> step_limited_runs(const Accuracy& accuracy);
/// The runs of Axis::grid with the newton_tolerance of the scene, of all integrators.
std::vector<const Run*> with_solver_of_scene(const Accuracy& accuracy);

/// One row per run with all its errors, for other programs. The field of an unknown value is empty.
Table accuracy_table(const Accuracy& accuracy);

/// Errors against CPU time, one panel per quantity.
std::string work_svg(const std::string& title, const Accuracy& accuracy);
/// Errors against the step; errors due to the solver against newton_tolerance; errors of the meshes against CPU time.
std::string settings_svg(const std::string& title, const Accuracy& accuracy);

/// The cheapest run of Axis::grid or Axis::tolerance that certainly reaches a target. Such a run, and all finer runs of
/// its axis and integrator that have not failed, have an error plus uncertainty of at most `target`. nullptr if there
/// is none.
const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target);
/// The Pareto front of Axis::grid and Axis::tolerance, cheapest first: the runs for which no other run is both cheaper
/// and, counting error plus uncertainty, more exact.
std::vector<const Run*> pareto_front(const Accuracy& accuracy, Quantity quantity);

/// One line: which setting to use, its cost, and the cost of the scene's setting. The target is an error of 1 % of the
/// cloth's size.
std::string recommendation(const Accuracy& accuracy);

/// Three sentences: the cheapest setting for each of several target errors; the factor on the CPU time for a tenth of
/// the error; the errors due to step, solver and mesh. Empty if nothing moves.
std::string conclusion(const Accuracy& accuracy);

/// The report, which begins with the recommendation. `work_plot`, `settings_plot`: names of the plots' files, in the
/// folder of the report.
std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot);

}  // namespace weft::bench
