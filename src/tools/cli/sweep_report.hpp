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
  std::filesystem::path video;   ///< of this run or, if SweepJob::equal_job names another, of that one
  nlohmann::ordered_json stats;  ///< null if the run wrote none
  ExitCode code = ExitCode::ok;
};

/// A heading and one row per run: the values that differ between runs, then the columns that scenes/data.md describes.
/// If the statistics lack a value, the cell of this value is empty.
bench::Table sweep_table(const std::vector<SweepResult>& results);

/// Writes a sheet with one picture per run, captioned with its values and with the CPU times of simulation and drawing
/// or, if the run failed, with the exit code. The picture is the one with index `frame` in the video; if `frame` is
/// missing or too large, the last one. A grey picture stands for a run without a picture, and for a picture whose size
/// differs from that of the first run with a picture. If no run has a picture, writes nothing, and removes the sheet of
/// an earlier sweep. If a PNG cannot hold all runs, the sheet shows the first ones, and a note says so.
void write_sweep_sheet(const std::filesystem::path& file, const std::vector<SweepResult>& results,
                       const std::string& heading, std::optional<int> frame);

/// The values that differ from other runs: "bend=1e-6  wind=[8,2,0]"; "as it is" if no value differs.
std::string label_of(const SweepRun& run);

}  // namespace weft::cli
