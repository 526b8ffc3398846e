// The keys of the scene format as a Markdown page, from the rule table that reads them.
#pragma once

#include <string>

namespace weft::docs {

/// A section with a table for each table of the format.
std::string scene_keys();
/// The same for sewing patterns.
std::string pattern_keys();

}  // namespace weft::docs
