// The runs of a sweep and their folders, for weft sweep and weft farm.
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

/// One run of a sweep, whose scene has been read and checked.
struct SweepJob {
  SweepRun run;
  std::uint64_t scene_hash = 0;
  std::optional<std::size_t> equal_job = {};  ///< index of an earlier job with the same scene, whose results are used
  std::filesystem::path folder = {};
  std::string scene = {};       ///< its name
  int frame_count = 1;          ///< of the scene
  bool may_find_camera = true;  ///< drawing may need all frames, as the scene has no camera or a computed one
  FrameRange drawn = {};        ///< frames to draw: all; in a farm, those of --frames

  std::filesystem::path video() const { return folder / (scene + ".mp4"); }
  std::filesystem::path stats() const { return folder / (scene + ".json"); }
  /// `key=value` for each --set.
  std::vector<std::string> overrides() const;
  /// Number of frames to simulate.
  int simulated_count() const { return may_find_camera ? frame_count : drawn.last() + 1; }
  /// Whether the video is of this scene, and the statistics are those of a successful run of it. In a farm, different
  /// tasks write the two files.
  bool is_done() const;
};

/// Reads and checks the scenes of all runs. If any scene has mistakes, throws Error(scene_invalid) with the mistakes of
/// all scenes. Also throws as read_list() and plan_sweep() do. Registers in `paths` the file with the list of runs, if
/// there is one, and the input files of all scenes.
std::vector<SweepJob> read_sweep(const SweepOptions& options, PathLedger& paths);

/// Registers the output folder in `paths`. Throws Error(output_failed) unless the folder is new, empty, or that of a
/// sweep with the same `passed_on` options, --threads aside; with `overwrite`, of any sweep. Also throws if the review
/// page `page` in the folder cannot be replaced. `can_overwrite`: whether the command has --overwrite, which the
/// message then names.
void check_sweep_folder(const SweepOptions& options, PathLedger& paths, bool can_overwrite);

/// Writes the index file (review::kSweepName), which also marks the folder as that of a sweep.
void write_sweep_index(const SweepOptions& options, const std::vector<SweepJob>& jobs);

}  // namespace weft::cli
