// The keys of the scene format as a Markdown page, from the rule table that reads them.
#pragma once

#include <string>

namespace weft::docs {

/// Returns a section for each table of the format, with a row for each key.
std::string scene_keys();
/// The same for the format of sewing patterns.
std::string pattern_keys();

}  // namespace weft::docs
