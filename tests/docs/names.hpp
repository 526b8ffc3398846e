// Names in code that documentation pages use: tests, files and identifiers.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace weft::docs {

/// The existing names.
struct Known {
  std::set<std::string> words;       ///< identifiers in sources, tests, shaders, scenes and scripts
  std::set<std::string> file_names;  ///< without their folders
  std::set<std::string> tests;       ///< Suite.Name as gtest lists it (parameters as 0), also without the prefix of the
                                     ///< instance
};

/// Reads all hand-written files under root.
Known read_known(const std::filesystem::path& root);

/// Returns "page: name" for each code span of the page that has the form of a test name, file name or identifier, but
/// does not exist. In test names, * is a wildcard.
std::string unknown_names(const std::filesystem::path& root, const std::filesystem::path& page, const Known& known);

}  // namespace weft::docs
