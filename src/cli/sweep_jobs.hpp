// The runs of a sweep with their folders, for all commands that make or watch them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/path_ledger.hpp"
#include "cli/sweep_plan.hpp"

namespace weft::cli {

/// One run, checked: nothing is made yet.
struct SweepJob {
  SweepRun run;
  std::uint64_t scene_hash = 0;
  std::optional<std::size_t> twin = {};  ///< an earlier run of the same scene, which is not made again
  std::filesystem::path folder = {};
  std::string scene = {};  ///< its name
  int frame_count = 1;     ///< of the scene

  std::filesystem::path video() const { return folder / (scene + ".mp4"); }
  std::filesystem::path stats() const { return folder / (scene + ".json"); }
  /// `key=value` for each --set.
  std::vector<std::string> overrides() const;
  /// Its video and statistics are there, of this very scene, to its end.
  bool is_done() const;
};

/// Reads all scenes: what is wrong with one ends the sweep at once. Throws Error (usage, scene_invalid,
/// asset_unreadable), with all mistakes of all scenes. `paths` learns what is read.
std::vector<SweepJob> read_sweep(const SweepOptions& options, PathLedger& paths);

/// The folder is new, empty, or one of the same sweep. Throws Error(output_failed).
void check_sweep_folder(const SweepOptions& options, PathLedger& paths);

/// Writes what the folder holds: also the mark of a folder that sweeps fill.
void write_sweep_index(const SweepOptions& options, const std::vector<SweepJob>& jobs);

}  // namespace weft::cli
