// The runs of a sweep and their folders, for all commands that make or watch them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/frame_range.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/sweep_plan.hpp"

namespace weft::cli {

/// One checked run; nothing is written yet.
struct SweepJob {
  SweepRun run;
  std::uint64_t scene_hash = 0;
  std::optional<std::size_t> twin = {};  ///< index of an earlier run of the same scene; its results are used
  std::filesystem::path folder = {};
  std::string scene = {};       ///< its name
  int frame_count = 1;          ///< of the scene
  bool may_find_camera = true;  ///< the scene has no camera or a computed one, so that drawing may need all frames
  FrameRange drawn = {};        ///< all frames; in a farm the requested ones

  std::filesystem::path video() const { return folder / (scene + ".mp4"); }
  std::filesystem::path stats() const { return folder / (scene + ".json"); }
  /// `key=value` for each --set.
  std::vector<std::string> overrides() const;
  /// Number of frames to simulate.
  int simulated_count() const { return may_find_camera ? frame_count : drawn.last() + 1; }
  /// Whether its video and statistics exist, belong to this scene, and are complete.
  bool is_done() const;
};

/// Reads the scenes of all runs. A mistake in one scene prevents all runs: throws Error(scene_invalid) with all
/// mistakes of all scenes. Also throws Error(usage) and Error(asset_unreadable). Registers in `paths` the file with the
/// list of runs, if there is one, and the input files of the first run's scene.
std::vector<SweepJob> read_sweep(const SweepOptions& options, PathLedger& paths);

/// Registers the output folder in `paths`. Throws Error(output_failed) unless the folder is new, empty, or of a sweep
/// with the same `passed_on` options (of any sweep with `overwrite`), or if its page cannot be replaced.
void check_sweep_folder(const SweepOptions& options, PathLedger& paths);

/// Writes the index of the folder, which also marks it as the folder of a sweep.
void write_sweep_index(const SweepOptions& options, const std::vector<SweepJob>& jobs);

}  // namespace weft::cli
