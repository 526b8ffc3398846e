// Error against run time as tables, plots and a conclusion.
#pragma once

#include <string>

#include "bench/accuracy.hpp"
#include "bench/report.hpp"

namespace weft::bench {

/// All runs with all errors, for other programs.
Table accuracy_table(const Accuracy& accuracy);

/// Errors against CPU time, a panel for each quantity.
std::string work_svg(const std::string& title, const Accuracy& accuracy);
/// Errors against the step, of the solver, of the mesh.
std::string settings_svg(const std::string& title, const Accuracy& accuracy);

/// Three sentences computed from the runs: which setting for which accuracy, what one more digit costs, and what
/// solver and mesh leave.
std::string conclusion(const Accuracy& accuracy);

/// The report; the plots are expected beside it under these names.
std::string accuracy_markdown(const std::string& title, const Accuracy& accuracy, const std::string& work_plot,
                              const std::string& settings_plot);

}  // namespace weft::bench
