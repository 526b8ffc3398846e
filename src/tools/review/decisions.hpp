// Reviewers' decisions about runs. The review page offers them for download as `review.json`; reviewers put this file
// into the folder of a run or a folder above it.
//
//     {"format": "weft review 1", "runs": {"stiff/band": {"state": "needs work", "of": "9f86d081884c7d65", "by": "Ann",
//      "date": "2026-11-23T19:40:00.000Z", "notes": [{"frame": 12, "text": "a fold stands up", "by": "Ann",
//      "date": "...", "of": "...", "marks": [[[0.41, 0.3], [0.47, 0.36]]]}]}}}
//
// The names of runs are paths below the folder of the file. `of`: fingerprint() of the reviewed pictures. Marks are
// polylines; their points are fractions of the picture's width and height, from the left and the top.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tools/review/find_runs.hpp"

namespace weft::review {

/// Reads files of decisions, and finds the entries of runs.
class Decisions {
 public:
  /// Returns the entry of a run; null if there is none. Reads the files in the folder of the run and in its parents, up
  /// to `run.folder`. Returns the valid entry with the latest date; if dates are equal or missing, the entry from the
  /// folder nearest to the run. Adds unusable files and entries to `run.problems`.
  Json of(RunFiles& run);

 private:
  struct File {
    Json runs = Json::object();
    std::string problem;  ///< why the file cannot be used; empty if the file is valid or does not exist
  };
  const File& read(const std::filesystem::path& folder);

  std::map<std::filesystem::path, File> files_;  // by folder
};

/// Describes the defect of an entry; empty if it is valid.
std::string mistake_of_decision(const Json& entry);

/// Hash of the bytes of the run's video, or of the hashes of its pictures: 16 hexadecimal digits; empty if it has none.
/// Throws Error(asset_unreadable).
std::string fingerprint(const RunFiles& run);

/// Modification time of the video, else the first picture, else the statistics: ISO 8601 in UTC; empty if none exists.
std::string date_of(const RunFiles& run);

}  // namespace weft::review
