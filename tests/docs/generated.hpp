// The parts of the documentation that the program generates from its tables. In a page, they are between `<!--
// generated: NAME -->` and `<!-- end -->`; `ninja docs` rewrites them.
#pragma once

#include <filesystem>
#include <string>

namespace weft::docs {

/// Returns the page `file` (relative to root), whose present content is `text`, with every generated part up to date.
/// Throws std::runtime_error if a name is unknown or an end is missing.
std::string regenerated(const std::filesystem::path& root, const std::filesystem::path& file, const std::string& text);

}  // namespace weft::docs
