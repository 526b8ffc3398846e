// Which runs a sweep has: combinations of values, rows of a list, or both.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace weft::cli {

/// Of a sweep; more are a slip: a day of runs of ten seconds.
inline constexpr std::size_t kMostRuns = 10'000;

/// A key of the scene and the texts of its values, as --set takes them.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// Reads `key=a,b,c`; commas within brackets, braces and quotes part nothing. Throws Error(usage).
Axis parse_axis(const std::string& text);

/// Changes of one run: keys and values, in the order in which they were given.
using Changes = std::vector<std::pair<std::string, std::string>>;

/// The rows of a list: CSV with the keys in its first line, or TOML with a table [[run]] for each. Throws
/// Error(asset_unreadable) with the line.
std::vector<Changes> read_list(const std::filesystem::path& file);

/// The same of the text of a file, which the ending of its name says how to read.
std::vector<Changes> parse_list(const std::filesystem::path& file, const std::string& raw);

struct SweepRun {
  Changes changes;     ///< all of them
  std::string name;    ///< of its folder: the values of what differs between runs
  Changes difference;  ///< what differs, by the shortest endings of the keys that tell them apart
};

/// Each row of the list with each combination of the axes, the last axis changing first. Runs that are asked for twice
/// are there once. Throws Error(usage) where a key is given twice, or there are more than 10,000 runs.
std::vector<SweepRun> plan_sweep(const std::vector<Changes>& list, const std::vector<Axis>& axes);

}  // namespace weft::cli
