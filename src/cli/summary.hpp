#pragma once

#include <string>

#include "cli/run_report.hpp"

namespace weft::cli {

/// What a run made and what it took, for people: several lines, without a line feed at the end. Warnings that the
/// figures give reason for come last.
std::string summary(const RunReport& report);

/// Hints at figures that look wrong: strain, rejected steps, surfaces that touch.
std::vector<std::string> find_warnings(const std::vector<FrameRecord>& frames);

}  // namespace weft::cli
