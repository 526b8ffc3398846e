// Reads from a Markdown page what the tests of the documentation check.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::docs {

/// A code block between ``` and ```.
struct Fence {
  std::string info;     ///< text after the opening marks: toml, sh, text
  std::string text;     ///< content; ends with a line feed
  std::string section;  ///< the second-level heading above it
  int line = 0;         ///< line of the opening marks, from 1
};

struct Page {
  std::vector<Fence> fences;
  std::vector<std::string> sections;  ///< second-level headings, in order
  std::vector<std::string> anchors;   ///< valid targets of #links: headings in lower case, hyphens for spaces
  std::vector<std::string> links;     ///< targets of links and pictures, as written
  std::vector<std::string> code;      ///< text between single backticks, spaces for line feeds
  std::string mistakes;               ///< "12: what is wrong", one line for each
};

/// Mistakes are unclosed fences, indented code (which no test runs), and tables whose rows differ in their number of
/// cells or whose second row is no delimiter row.
Page read_page(const std::string& text);

/// All hand-written pages, relative to root, sorted by name.
std::vector<std::filesystem::path> pages(const std::filesystem::path& root);

}  // namespace weft::docs
