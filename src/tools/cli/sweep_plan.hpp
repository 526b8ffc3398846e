// The runs of a sweep: combinations of values, rows of a list, or both.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace weft::cli {

/// Limit on the number of runs, so that a mistake does not start too many. 10,000 runs of ten seconds each take a day.
inline constexpr std::size_t kMaxRuns = 10'000;

/// A key of the scene, and its values as the text that --set expects.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// Parses `key=a,b,c`; commas within brackets, braces and quotes do not separate values. Throws Error(usage).
Axis parse_axis(const std::string& text);

/// The changes of one run: keys and values, in the order in which the user gave them.
using Changes = std::vector<std::pair<std::string, std::string>>;

/// Reads a list of runs: CSV with the keys in its first line and one run per row, or TOML with a table [[run]] for each
/// run. Throws Error(asset_unreadable), for a syntax error with the line.
std::vector<Changes> read_list(const std::filesystem::path& file);

/// Parses the text of a list; the extension of `file` selects the format.
std::vector<Changes> parse_list(const std::filesystem::path& file, const std::string& raw);

struct SweepRun {
  Changes changes;     ///< all changes of the scene
  std::string name;    ///< name of the run's folder, made from `difference`
  Changes difference;  ///< the changes that differ between runs (all, if there is one run); keys are shortened to
                       ///< unique endings
};

/// Combines each row of the list with each combination of the values of all axes; the last axis varies fastest. Removes
/// duplicate runs. Throws Error(usage) if a key is given twice or there are more than kMaxRuns runs.
std::vector<SweepRun> plan_sweep(const std::vector<Changes>& list, const std::vector<Axis>& axes);

}  // namespace weft::cli
