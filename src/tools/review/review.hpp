// `weft review`: writes a folder of static files for viewing runs; no server is needed.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "tools/review/find_runs.hpp"

namespace weft::review {

struct Request {
  std::vector<std::filesystem::path> folders;  ///< folders with runs
  std::filesystem::path reference;             ///< folder with runs to compare with; empty: none
  std::filesystem::path output;                ///< folder of the page
  bool overwrite = false;
  std::function<bool()> stop = [] { return false; };  ///< called before each run; true: interrupt
};

struct Outcome {
  std::filesystem::path page;  ///< index.html
  int runs = 0;
  int incomplete = 0;                  ///< number of runs with problems, such as unreadable files
  int approved = 0, needing_work = 0;  ///< number of runs with this decision about their current pictures
  /// Number of runs with a picture that differs from its reference by more than the default limits
  /// of `weft diff`.
  int differing = 0;
};

/// Writes the page. Throws Error(asset_unreadable) if a folder cannot be listed or no folder
/// contains runs, Error(reference_missing) if the reference is not a folder with runs,
/// Error(output_failed) if the page cannot be written, and Error(interrupted) if `stop` returns
/// true.
Outcome write_review(const Request& request);

/// Returns JSON in which each `<` is escaped, so that no text in `data` can end the script element
/// around the JSON.
std::string script_json(const Json& data);

/// Fills `page`, the template of index.html, with the version of Weft and with `data` as JSON.
/// Throws Error(internal) if the template lacks a placeholder.
std::string page_html(std::string_view page, const Json& data);

}  // namespace weft::review
