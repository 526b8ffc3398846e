// The parts of the documentation that are printed from the program's own tables. In a page they stand between
// `<!-- generated: NAME -->` and `<!-- end -->`; `ninja docs` writes them anew.
#pragma once

#include <filesystem>
#include <string>

namespace weft::docs {

/// The page `file` (relative to root) with every generated part as it should be now. Throws std::runtime_error for a
/// name that is not known, and where the end is missing.
std::string regenerated(const std::filesystem::path& root, const std::filesystem::path& file, const std::string& text);

}  // namespace weft::docs
