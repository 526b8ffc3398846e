// The error estimate of `--error`, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "film/run_error/companions.hpp"

namespace weft::cli {

/// A table: a heading, one line per source of error, and one for all sources together (root of the sum of squares).
/// Below it, one line for each source whose error is not known, and one with the CPU time of the companion runs
/// (companions.hpp). No line feed at the end.
std::string error_summary(const run_error::ErrorEstimate& estimate);

/// One sentence with the error of positions, its main source, and how to reduce it. If the motion is chaotic, the
/// sentence says that no setting reduces the error. `cloth_size`: RunReport::cloth_size [m]; if it is 0, the text has
/// no relative length.
std::string error_sentence(const run_error::ErrorEstimate& estimate, double cloth_size);

/// A length [m] as text, in mm and relative to `cloth_size`: "1.2 mm (0.12 % of the cloth's size)".
/// If `cloth_size` is 0, only in mm.
std::string relative_length(double length, double cloth_size);

/// The estimate in SI units: {"comparable", "parts": {"time_steps": {"position_m", ...}, ...}, "all", "advice",
/// "cpu_s"}.
nlohmann::ordered_json error_json(const run_error::ErrorEstimate& estimate);

}  // namespace weft::cli
