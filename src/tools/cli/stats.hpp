// The JSON that --stats and --log-json write.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/cli/run_report.hpp"

namespace weft::cli {

/// The values of one frame: run times in ms, everything else in SI units. Infinite values and NaN become null.
nlohmann::ordered_json frame_json(const FrameRecord& record);

/// The content of the --stats file.
nlohmann::ordered_json stats_json(const RunReport& report);

}  // namespace weft::cli
