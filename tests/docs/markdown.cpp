#include "docs/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

// The anchor that GitHub makes of a heading: lower case, no punctuation, hyphens for spaces.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80) {
      anchor += static_cast<char>(std::tolower(byte));
    } else if (c == ' ') {
      anchor += '-';
    }
  }
  return anchor;
}

// Number of cells of a row such as `| a | b \| c |`.
int cells(const std::string& row) {
  int bars = 0;
  for (std::size_t i = 0; i < row.size(); ++i) bars += row[i] == '|' && (i == 0 || row[i - 1] != '\\');
  return bars - 1;
}

// Reads a page line by line.
class Reader {
 public:
  explicit Reader(Page& page) : page_(page) {}

  void read(const std::string& line) {
    ++number_;
    if (line.starts_with("```")) {
      toggle_fence(line);
    } else if (in_fence_) {
      page_.fences.back().text += line + "\n";
    } else {
      if (line.starts_with("#")) read_heading(line);
      check_table(line);
      if (line.starts_with("    ") && blank_before_) complain("code by indentation: put it between ```");
      prose_ += line + "\n";
      blank_before_ = line.empty();
    }
  }

  void finish() {
    if (in_fence_) complain("a block of code is not closed");
    check_table("");
    const auto each = [&](const char* pattern, std::string& text, std::vector<std::string>& found) {
      const std::regex regex(pattern);
      for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        found.push_back((*match)[1]);
      text = std::regex_replace(text, regex, "");
    };
    each("`([^`]+)`", prose_, page_.code);
    for (std::string& code : page_.code) std::replace(code.begin(), code.end(), '\n', ' ');
    each(R"(\]\(([^)\s]+)\))", prose_, page_.links);
  }

 private:
  void complain(const std::string& what) { page_.mistakes += fmt::format("{}: {}\n", number_, what); }

  void toggle_fence(const std::string& line) {
    in_fence_ = !in_fence_;
    if (in_fence_)
      page_.fences.push_back({line.substr(3), "", page_.sections.empty() ? "" : page_.sections.back(), number_});
  }

  void read_heading(const std::string& line) {
    const std::string heading = line.substr(std::min(line.find_first_not_of("# "), line.size()));
    page_.anchors.push_back(anchor_of(heading));
    if (line.starts_with("## ")) page_.sections.push_back(heading);
  }

  void check_table(const std::string& line) {
    if (!line.starts_with("|")) {
      if (table_rows_ == 1) complain("a table of one row");
      table_rows_ = 0;
      return;
    }
    ++table_rows_;
    if (table_rows_ == 1) columns_ = cells(line);
    if (table_rows_ == 2 && line.find_first_not_of("|-: ") != std::string::npos) complain("no line below the head");
    if (cells(line) != columns_) complain(fmt::format("{} cells, {} in the head", cells(line), columns_));
  }

  Page& page_;
  std::string prose_;  // everything outside fences
  int number_ = 0, table_rows_ = 0, columns_ = 0;
  bool in_fence_ = false, blank_before_ = true;
};

}  // namespace

Page read_page(const std::string& text) {
  Page page;
  Reader reader(page);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) reader.read(line);
  reader.finish();
  return page;
}

std::vector<fs::path> pages(const fs::path& root) {
  std::vector<fs::path> found = {"README.md"};
  for (const char* folder : {".github", "src", "scenes", "shaders", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() == ".md") found.push_back(entry.path().lexically_relative(root));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace weft::docs
