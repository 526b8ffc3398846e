// What the tests of the documentation read in a Markdown page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::docs {

/// A block between ``` and ```.
struct Fence {
  std::string info;     ///< what follows the opening marks: toml, sh, text
  std::string text;     ///< ends with a line feed
  std::string section;  ///< the heading of second level above it
  int line = 0;         ///< of the opening marks, from 1
};

struct Page {
  std::vector<Fence> fences;
  std::vector<std::string> sections;  ///< headings of second level, in order
  std::vector<std::string> anchors;   ///< what #links may name: headings in small letters, spaces as hyphens
  std::vector<std::string> links;     ///< targets of links and pictures, as written
  std::vector<std::string> code;      ///< what stands between single backticks, line feeds as spaces
  std::string mistakes;               ///< "12: what is wrong" for each
};

/// Mistakes are fences that are not closed, code by indentation, which no test runs, and tables whose rows have not all
/// the same number of cells or whose second row does not draw the line below the head.
Page read_page(const std::string& text);

/// All pages that we write, relative to root, in order of their names.
std::vector<std::filesystem::path> pages(const std::filesystem::path& root);

/// The bytes of a file; throws std::runtime_error where it cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace weft::docs
