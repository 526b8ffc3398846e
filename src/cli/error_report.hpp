// What `--error` found out about a run, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/companions.hpp"

namespace weft::cli {

/// A line for each source of error and one for all of them, and one with what lessens the largest; without a line feed
/// at the end. Where paths part, what cannot be compared is left out.
std::string error_summary(const bench::ErrorEstimate& estimate);

/// The same in SI units: {"comparable", "parts": {"time_steps": {"position_m", ...}, ...}, "all", "advice", "cpu_s"}.
nlohmann::ordered_json error_json(const bench::ErrorEstimate& estimate);

}  // namespace weft::cli
