// What came of the runs of a sweep: a table, and a sheet with a picture of each.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "cli/sweep_plan.hpp"
#include "core/error.hpp"

namespace weft::cli {

struct SweepResult {
  SweepRun run;
  std::filesystem::path video;   ///< of this run, or of the one with the same scene
  nlohmann::ordered_json stats;  ///< null where it left none
  ExitCode code = ExitCode::ok;
};

/// A row for each run: its values, then the columns that scenes/data.md describes. What a run did not report is empty.
bench::Table sweep_table(const std::vector<SweepResult>& results);

/// A picture of each run with its values and the CPU time of simulation and drawing; grey where there is none. Of the
/// last frame that is there, without `frame`: the k-th of those that were drawn. Writes nothing where no run has a
/// picture.
void write_sweep_sheet(const std::filesystem::path& file, const std::vector<SweepResult>& results,
                       const std::string& heading, std::optional<int> frame);

/// "bend=1e-6  wind=[8,2,0]"; "as it is" where nothing differs.
std::string label_of(const SweepRun& run);

}  // namespace weft::cli
