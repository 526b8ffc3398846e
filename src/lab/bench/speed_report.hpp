// Tables, plots and a conclusion about the cost of runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/bench/report.hpp"
#include "lab/bench/speed.hpp"

namespace weft::bench {

struct SpeedReport {
  std::string title, machine;  ///< `title` names the scene, `machine` the processor
  SpeedFrames frames;
  std::vector<SpeedRun> runs;
};

/// One row per run, for other programs. Times are milliseconds per frame; an unknown value is an empty field.
Table speed_table(const std::vector<SpeedRun>& runs);

/// Successful runs of ascending sizes, with the smallest number of threads and the scene's step.
std::vector<const SpeedRun*> over_sizes(const std::vector<SpeedRun>& runs);
/// Successful runs of ascending numbers of threads, at this size and the scene's step.
std::vector<const SpeedRun*> over_threads(const std::vector<SpeedRun>& runs, double size);
/// Successful runs from the longest step to the shortest, at the size and number of threads of the first run with
/// another step than the scene's; empty if there is none.
std::vector<const SpeedRun*> over_steps(const std::vector<SpeedRun>& runs);

/// Exponent with which a value grows with the number of particles between two runs; nullopt unless the particles
/// grow and both values are positive.
std::optional<double> exponent(const SpeedRun& small, const SpeedRun& large, double of_small, double of_large);

/// Sentences computed from the runs: cost of a frame and its growth, gain by threads, memory, and the ratio of the
/// memory bound to the solver's time.
std::string conclusion(const std::vector<SpeedRun>& runs);

std::string speed_svg(const SpeedReport& report);
/// The report. It refers to the plot by this name, as a file beside it.
std::string speed_markdown(const SpeedReport& report, const std::string& plot);

}  // namespace weft::bench
