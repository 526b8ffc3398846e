// Results of a sweep: a table, and a sheet with one picture per run.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "lab/bench/report.hpp"
#include "tools/cli/sweep_plan.hpp"

namespace weft::cli {

struct SweepResult {
  SweepRun run;
  std::filesystem::path video;   ///< of this run, or of its twin
  nlohmann::ordered_json stats;  ///< null if the run wrote none
  ExitCode code = ExitCode::ok;
};

/// One row per run: its values, then the columns that scenes/data.md describes. Values that are missing in the
/// statistics are empty.
bench::Table sweep_table(const std::vector<SweepResult>& results);

/// Writes a sheet with one picture per run, its values, and the CPU time of simulation and drawing, or the exit code if
/// the run failed. The picture is the drawn frame with index `frame`; if `frame` is missing or too large, the last one.
/// It is grey if the run has no picture, or one of another size than the first. Writes nothing if no run has a picture.
/// If there are more runs than a PNG can hold, the sheet shows the first ones, and a note says so.
void write_sweep_sheet(const std::filesystem::path& file, const std::vector<SweepResult>& results,
                       const std::string& heading, std::optional<int> frame);

/// "bend=1e-6  wind=[8,2,0]"; "as it is" if nothing differs.
std::string label_of(const SweepRun& run);

}  // namespace weft::cli
