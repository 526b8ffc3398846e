// The result of `--error`, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "film/run_error/companions.hpp"

namespace weft::cli {

/// A table with a heading, one line per source of error, and one for all of them (root of the sum of squares); then one
/// line for each source that is not known, and one with the CPU time of the companion runs (companions.hpp). No line
/// feed at the end.
std::string error_summary(const run_error::ErrorEstimate& estimate);

/// One sentence: the error of positions, its main source, and how to reduce it; for a chaotic motion, that no setting
/// reduces it. `cloth_size` [m]; 0: not known.
std::string error_sentence(const run_error::ErrorEstimate& estimate, double cloth_size);

/// A length [m] in mm and relative to the size of the cloth [m]: "1.2 mm (0.12 % of the cloth's size)".
std::string relative_length(double length, double cloth_size);

/// The estimate in SI units: {"comparable", "parts": {"time_steps": {"position_m", ...}, ...}, "all", "advice",
/// "cpu_s"}.
nlohmann::ordered_json error_json(const run_error::ErrorEstimate& estimate);

}  // namespace weft::cli
