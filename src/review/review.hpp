// `weft review`: one static folder for looking at runs, which opens without a server.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "review/find_runs.hpp"

namespace weft::review {

struct Request {
  std::vector<std::filesystem::path> folders;  ///< with runs
  std::filesystem::path reference;             ///< folder with runs to compare with; empty: none
  std::filesystem::path output;
  bool overwrite = false;
  std::function<bool()> stop = [] { return false; };  ///< asked between runs
};

struct Outcome {
  std::filesystem::path page;
  int runs = 0;
  int incomplete = 0;                  ///< of them, with something missing
  int approved = 0, needing_work = 0;  ///< of them, as they are now
  int differing = 0;  ///< of them, whose pictures differ from the reference past the limits of weft diff
};

/// Writes the page. Throws Error: asset_unreadable for folders without runs, reference_missing for a reference that is
/// no folder with runs, output_failed, interrupted.
Outcome write_review(const Request& request);

/// JSON of which no part can end a script element, or begin one.
std::string script_json(const Json& data);

/// The text of index.html around `data`, which a script element holds as JSON.
std::string page_html(std::string_view page, const Json& data);

}  // namespace weft::review
