// What `--error` found out about a run, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/companions.hpp"

namespace weft::cli {

/// A line for each source of error and one for all of them, and what they took; without a line feed at the end.
std::string error_summary(const bench::ErrorEstimate& estimate);

/// How far positions may be off, by whose doing, and what lessens it: one sentence. `cloth_size` [m]; 0: not known.
std::string error_sentence(const bench::ErrorEstimate& estimate, double cloth_size);

/// A length [m] in mm and as a ratio to the size of the cloth [m]: "1.2 mm (0.12 % of the cloth's size)".
std::string relative_length(double length, double cloth_size);

/// The same in SI units: {"comparable", "parts": {"time_steps": {"position_m", ...}, ...}, "all", "advice", "cpu_s"}.
nlohmann::ordered_json error_json(const bench::ErrorEstimate& estimate);

}  // namespace weft::cli
