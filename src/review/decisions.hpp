// What people decided about runs: `review.json` in the folder of a run or above it, as the page offers it for download.
//
//     {"format": "weft review 1", "runs": {"stiff/band": {"state": "needs work", "of": "9f86d081884c7d65", "by": "Ann",
//      "date": "2026-11-23T19:40:00.000Z", "notes": [{"frame": 12, "text": "a fold stands up", "by": "Ann",
//      "date": "...", "of": "...", "marks": [[[0.41, 0.3], [0.47, 0.36]]]}]}}}
//
// Names are those below the folder of the file. `of`: the fingerprint of the pictures that were looked at. Marks are
// lines through points in shares of the picture's width and height, from the left and the top.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "review/find_runs.hpp"

namespace weft::review {

class Decisions {
 public:
  /// The entry of a run, of the file nearest to it; null where there is none. What cannot be used is added to
  /// `run.problems`.
  Json of(RunFiles& run);

 private:
  struct File {
    Json runs = Json::object();
    std::string problem;  ///< why it cannot be used; empty: it can, or is not there
  };
  const File& read(const std::filesystem::path& folder);

  std::map<std::filesystem::path, File> files_;  // by folder
};

/// What is wrong with an entry; empty: nothing.
std::string mistake_of_decision(const Json& entry);

/// Of the bytes of the run's video or pictures: 16 hexadecimal digits; empty where it has none. Throws
/// Error(asset_unreadable).
std::string fingerprint(const RunFiles& run);

/// When the video was written, or else the first picture or the statistics: ISO 8601 in UTC; empty where nothing tells.
std::string date_of(const RunFiles& run);

}  // namespace weft::review
