#pragma once

#include <string>

#include "tools/cli/run_report.hpp"

namespace weft::cli {

/// Describes result and cost of a run in several lines, without a line feed at the end. The last lines are the notes
/// and warnings of the report.
std::string summary(const RunReport& report);

/// Warnings about suspicious figures, such as large strain, many rejected steps, or touching surfaces.
std::vector<std::string> find_warnings(const std::vector<FrameRecord>& frames);

}  // namespace weft::cli
