// Error against run time as tables, plots and a conclusion.
#pragma once

#include <string>
#include <vector>

#include "bench/accuracy.hpp"
#include "bench/report.hpp"

namespace weft::bench {

/// Runs of all integrators: along an axis; of the grid where the step decides, and with the solver settings of the
/// scene.
std::vector<const Run*> of_axis(const Accuracy& accuracy, Axis axis);
std::vector<const Run*> deciding(const Accuracy& accuracy);
std::vector<const Run*> with_solver_of_scene(const Accuracy& accuracy);

/// All runs with all errors, for other programs; what is not known is empty.
Table accuracy_table(const Accuracy& accuracy);

/// Errors against CPU time, a panel for each quantity.
std::string work_svg(const std::string& title, const Accuracy& accuracy);
/// Errors against the step, of the solver, of the mesh.
std::string settings_svg(const std::string& title, const Accuracy& accuracy);

/// The run with the least CPU time whose error is known to be at most `target`, as are those of all runs that are
/// solved more exactly in the same way; null where there is none.
const Run* cheapest(const Accuracy& accuracy, Quantity quantity, double target);
/// Runs than which none is both cheaper and more exact, from the cheapest on.
std::vector<const Run*> front(const Accuracy& accuracy, Quantity quantity);

/// One line: which setting to use, what it costs, and what the settings of the scene cost. Wanted is an error of 1 % of
/// the cloth's size.
std::string recommendation(const Accuracy& accuracy);

/// Three sentences computed from the runs: which setting for which accuracy, what one more digit costs, and what
/// step, solver and mesh leave; empty where nothing moves.
std::string conclusion(const Accuracy& accuracy);

/// The report, with the recommendation first; the plots are expected beside it under these names.
std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot);

}  // namespace weft::bench
