// Tables, plots and conclusions of error against run time.
#pragma once

#include <string>
#include <vector>

#include "lab/bench/accuracy.hpp"
#include "lab/bench/report.hpp"

namespace weft::bench {

/// Runs of all integrators. runs_of_axis: all runs of one axis. deciding: the runs of Axis::grid in which the step
/// decides. with_solver_of_scene: the runs of Axis::grid with the solver settings of the scene.
std::vector<const Run*> runs_of_axis(const Accuracy& accuracy, Axis axis);
std::vector<const Run*> deciding(const Accuracy& accuracy);
std::vector<const Run*> with_solver_of_scene(const Accuracy& accuracy);

/// All runs with all errors, for other programs; an unknown value is an empty field.
Table accuracy_table(const Accuracy& accuracy);

/// Errors against CPU time, one panel per quantity.
std::string work_svg(const std::string& title, const Accuracy& accuracy);
/// Errors against step, solver tolerance and mesh.
std::string settings_svg(const std::string& title, const Accuracy& accuracy);

/// The cheapest run whose error is certainly at most `target`, as are the errors of all finer runs of its axis and
/// integrator; nullptr if there is none.
const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target);
/// The Pareto front: runs for which no other run is both cheaper and more exact, cheapest first.
std::vector<const Run*> front(const Accuracy& accuracy, Quantity quantity);

/// One line: which setting to use, its cost, and the cost of the scene's setting. The target error is 1 % of the
/// cloth's size.
std::string recommendation(const Accuracy& accuracy);

/// Three sentences computed from the runs: the cheapest setting for each accuracy, the cost of one more digit, and the
/// errors due to step, solver and mesh. Empty if nothing moves.
std::string conclusion(const Accuracy& accuracy);

/// The report, with the recommendation first. It refers to the plots by these names, as files beside it.
std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot);

}  // namespace weft::bench
