// What pages of the documentation name in the code: tests, files and identifiers.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace weft::docs {

/// What may be named.
struct Known {
  std::set<std::string> words;       ///< identifiers in sources, tests, shaders, scenes and scripts
  std::set<std::string> file_names;  ///< without their folders
  std::set<std::string> tests;       ///< Suite.Name, as gtest lists them (parameters as 0), and without their prefix
};

/// Reads all that we write under root.
Known read_known(const std::filesystem::path& root);

/// "page: what is named and not there" for each code span of the page that looks like the name of a test, of a file or
/// of something in the sources, and is none. In names of tests * stands for anything.
std::string unknown_names(const std::filesystem::path& root, const std::filesystem::path& page, const Known& known);

}  // namespace weft::docs
