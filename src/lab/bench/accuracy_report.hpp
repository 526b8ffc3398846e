// Tables, plots and conclusions of error against run time.
#pragma once

#include <string>
#include <vector>

#include "lab/bench/accuracy.hpp"
#include "lab/bench/report.hpp"

namespace weft::bench {

/// All runs of one axis, of all integrators.
std::vector<const Run*> runs_of_axis(const Accuracy& accuracy, Axis axis);
/// The runs of Axis::grid whose error comes from the step, not from the solver (Run::step_decides).
std::vector<const Run*> deciding(const Accuracy& accuracy);
/// The runs of Axis::grid with the newton_tolerance of the scene, of all integrators.
std::vector<const Run*> with_solver_of_scene(const Accuracy& accuracy);

/// All runs with all errors, for other programs; an unknown value is an empty field.
Table accuracy_table(const Accuracy& accuracy);

/// Errors against CPU time, one panel per quantity.
std::string work_svg(const std::string& title, const Accuracy& accuracy);
/// Errors against step, solver tolerance and mesh.
std::string settings_svg(const std::string& title, const Accuracy& accuracy);

/// The cheapest run of Axis::grid or Axis::tolerance such that the error plus uncertainty of it, and of all finer runs
/// of its axis and integrator, is at most `target`; nullptr if there is none.
const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target);
/// The Pareto front of Axis::grid and Axis::tolerance, cheapest first: runs for which no other run is both cheaper and
/// more exact (by error plus uncertainty).
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
