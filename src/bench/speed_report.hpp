// What runs take as a table, plots and a conclusion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "bench/speed.hpp"

namespace weft::bench {

struct SpeedReport {
  std::string title, machine;  ///< of the scene; the processor
  SpeedFrames frames;
  std::vector<SpeedRun> runs;
};

/// A row for each run, for other programs; milliseconds are those of a frame, and what is not known is empty.
Table speed_table(const std::vector<SpeedRun>& runs);

/// Runs that went well and differ in one thing alone, from small to large: in size, with the least threads and the
/// step of the scene; in threads, at this size; in steps, from the longest on.
std::vector<const SpeedRun*> over_sizes(const std::vector<SpeedRun>& runs);
std::vector<const SpeedRun*> over_threads(const std::vector<SpeedRun>& runs, double size);
std::vector<const SpeedRun*> over_steps(const std::vector<SpeedRun>& runs);

/// With what power of the particles a figure grows from one run to another; nothing where it or they do not.
std::optional<double> exponent(const SpeedRun& small, const SpeedRun& large, double of_small, double of_large);

/// Sentences computed from the runs: what a frame takes and how that grows, what threads gain, memory, and how far the
/// solver is from what memory allows.
std::string conclusion(const std::vector<SpeedRun>& runs);

std::string speed_svg(const SpeedReport& report);
/// The plot is expected beside it under this name.
std::string speed_markdown(const SpeedReport& report, const std::string& plot);

}  // namespace weft::bench
