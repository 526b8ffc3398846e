// Finds what `weft run` left in folders, and which of the files belong together.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace weft::review {

using Json = nlohmann::ordered_json;

/// The files of one run. What is empty was not found.
struct RunFiles {
  std::filesystem::path folder;  ///< that was searched
  std::string key;               ///< path below it without ending, such as "stiff/falling_band"
  std::string name;              ///< the same, which may become longer where several folders are searched
  std::filesystem::path video;   ///< MP4
  std::vector<std::filesystem::path> pictures;  ///< numbered PNG files in order, where there is no video
  std::filesystem::path stats;
  Json stats_json;  ///< content of `stats`
  std::filesystem::path effective;
  std::vector<std::string> problems;  ///< files that cannot be used, each with the reason
  Json values;                        ///< of a sweep: what it changed, by key; null elsewhere
};

/// What weft sweep leaves beside its runs: `runs`, each with its `folder` and the values that were `set`.
inline constexpr const char* kSweepName = "sweep.json";

/// All runs below `folder`, in order of their names; those of a sweep in its own. Hidden files and review pages are
/// passed over. Throws Error(asset_unreadable) where `folder` is none or cannot be listed.
std::vector<RunFiles> find_runs(const std::filesystem::path& folder);

/// Whether `run.stats_json` holds the statistics of a run. What the page could not show of them is left out of it, and
/// named in the problems of the run.
bool take_statistics(RunFiles& run);

/// The file with decisions about runs; see decisions.hpp.
inline constexpr const char* kDecisionsName = "review.json";

/// The number at the end of a picture's name before the ending: 12 for band_00012.png; -1 if there is none.
long long picture_number(const std::filesystem::path& picture);

/// Whether `folder` is a page that `weft review` wrote.
bool is_review_page(const std::filesystem::path& folder);

/// What tells our pages from other ones: stands in index.html.
inline constexpr const char* kPageMark = "name=\"generator\" content=\"weft review";

}  // namespace weft::review
