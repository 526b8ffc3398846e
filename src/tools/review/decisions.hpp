// Reviewers' decisions about runs. The review page offers them for download as `review.json`; reviewers put this file
// into the folder of a run or a folder above it.
//
//     {"format": "weft review 1", "runs": {"stiff/band": {"state": "needs work", "of": "9f86d081884c7d65", "by": "Ann",
//      "date": "2026-11-23T19:40:00.000Z", "notes": [{"frame": 12, "text": "a fold stands up", "by": "Ann",
//      "date": "...", "of": "...", "marks": [[[0.41, 0.3], [0.47, 0.36]]]}]}}}
//
// Each key of `runs` is the path of a run below the folder of the file. `of` is the fingerprint()
// of the reviewed pictures. `marks` is a list of polylines; their points are fractions of the
// picture's width and height, from the left and the top.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tools/review/find_runs.hpp"

namespace weft::review {

/// Reads the files `review.json`, and finds the entry of each run.
class Decisions {
 public:
  /// Returns the valid entry of a run; null if there is none. Reads `review.json` in the folder of
  /// the run and in its parents up to `run.folder`. If several files have a valid entry, returns
  /// the one with the latest date; an entry without a date counts as the oldest. If dates are
  /// equal, returns the entry from the folder nearest to the run. Adds the defects of unusable
  /// files and entries to `run.problems`.
  Json of(RunFiles& run);

 private:
  struct File {
    Json runs = Json::object();
    std::string problem;  ///< why the file cannot be used; empty if the file is valid or does not exist
  };
  const File& read(const std::filesystem::path& folder);

  std::map<std::filesystem::path, File> files_;  // by folder
};

/// Returns the defect of an entry as text; empty if the entry is valid.
std::string mistake_of_decision(const Json& entry);

/// Returns the hash of the bytes of the run's video or, if there is no video, of the hashes of its
/// pictures: 16 hexadecimal digits. Returns an empty text if the run has neither. Throws
/// Error(asset_unreadable) if a file cannot be read.
std::string fingerprint(const RunFiles& run);

/// Modification time of the video, else the first picture, else the statistics: ISO 8601 in UTC; empty if none exists.
std::string date_of(const RunFiles& run);

}  // namespace weft::review
