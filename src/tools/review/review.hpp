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
  std::function<bool()> stop = [] { return false; };  ///< called between runs; true: interrupt
};

struct Outcome {
  std::filesystem::path page;  ///< index.html
  int runs = 0;
  int incomplete = 0;                  ///< number of runs with problems, such as unreadable files
  int approved = 0, needing_work = 0;  ///< number of runs with this decision about their current pictures
  int differing = 0;                   ///< number of runs that exceed the default limits of weft diff
};

/// Writes the page. Throws Error(asset_unreadable) if the folders contain no runs, Error(reference_missing) if the
/// reference is not a folder with runs, Error(output_failed), and Error(interrupted) if `stop` returns true.
Outcome write_review(const Request& request);

/// JSON that is safe inside a script element, since it contains no `<`.
std::string script_json(const Json& data);

/// Returns `page`, the template of index.html, with the version of Weft and with `data` as JSON in a script element.
std::string page_html(std::string_view page, const Json& data);

}  // namespace weft::review
