// Finds the files that `weft run` has written, and groups them by run.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace weft::review {

using Json = nlohmann::ordered_json;

/// The files of one run. A member is empty if the file was not found.
struct RunFiles {
  std::filesystem::path folder;  ///< folder that was searched
  /// Path below `folder` without extension, such as "stiff/falling_band"; if another run of `folder` has this path too,
  /// with " (pictures)" or " (video)" behind it.
  std::string key;
  std::string
      name;  ///< the path alone; if several folders are searched, with the name of `folder` and a slash before it
  std::filesystem::path video;                  ///< MP4
  std::vector<std::filesystem::path> pictures;  ///< numbered PNG files in order, if there is no video
  std::filesystem::path stats;                  ///< JSON file of --stats
  Json stats_json;                    ///< content of `stats`, without invalid values; null if there is no such file
  std::filesystem::path effective;    ///< effective scene: the scene with all defaults and changes
  std::vector<std::string> problems;  ///< unusable files and values, each with reason
  Json values;                        ///< values that a sweep changed, by key; else null
};

/// Name of the index file that `weft sweep` and `weft farm` write into the folder of their runs.
/// For each run, the list `runs` contains its `folder` and, in `set`, the values that the sweep
/// changed.
inline constexpr const char* kSweepName = "sweep.json";

/// All runs below `folder`, ordered by name; runs of a sweep in the order of the sweep. Skips
/// hidden files and folders, links and review pages. Throws Error(asset_unreadable) if `folder` is
/// not a folder or cannot be listed.
std::vector<RunFiles> find_runs(const std::filesystem::path& folder);

/// Name of a folder: "p" for p and p/, and for "." if p is the working folder.
std::string folder_name(const std::filesystem::path& folder);

/// Returns whether `run.stats_json` has the form of statistics of a run. If so, removes the values that the page cannot
/// show, and adds their names to `run.problems`.
bool take_statistics(RunFiles& run);

/// The file with decisions about runs; see decisions.hpp.
inline constexpr const char* kDecisionsName = "review.json";

/// The number at the end of the file name without extension: 12 for band_00012.png. Returns -1 if
/// the name ends in no number, or if the number does not fit.
long long picture_number(const std::filesystem::path& picture);

/// Whether `folder` contains a page of `weft review`: kPageMark is in the first 1024 bytes of its
/// index.html.
bool is_review_page(const std::filesystem::path& folder);

/// Text that index.html of every review page contains.
inline constexpr const char* kPageMark = "name=\"generator\" content=\"weft review";

}  // namespace weft::review
