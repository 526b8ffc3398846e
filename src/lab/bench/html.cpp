#include "lab/bench/html.hpp"

#include <fmt/format.h>

#include <regex>
#include <sstream>
#include <vector>

#include "core/markup.hpp"

namespace weft::bench {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;display:block;overflow-x:auto}"
    "th,td{border:1px solid #ccc;padding:.2em .6em;text-align:right;white-space:nowrap}"
    "th:first-child,td:first-child{text-align:left}th{background:#f4f4f2}svg{max-width:100%;height:auto}"
    "code{background:#f4f4f2}";

// Converts `code` and **strong** to HTML.
std::string inline_html(const std::string& text) {
  static const std::regex kStrong(R"(\*\*([^*]+)\*\*)"), kCode("`([^`]+)`");
  return std::regex_replace(std::regex_replace(markup_text(text), kCode, "<code>$1</code>"), kStrong,
                            "<strong>$1</strong>");
}

// Splits a table row into cells; `\|` is a literal bar.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|')
      cells.back() += line[++i];
    else if (line[i] == '|')
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  cells.pop_back();  // no cell follows the last bar
  return cells;
}

std::string row_html(const std::string& line, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells_of(line)) row += fmt::format("<{0}>{1}</{0}>", tag, inline_html(cell));
  return row + "</tr>\n";
}

}  // namespace

std::string html_page(const std::string& title, const std::string& markdown, const FindPlot& find_plot) {
  static const std::regex kPlot(R"(!\[[^\]]*\]\(([^)]*)\))");
  std::string body, paragraph;
  bool in_table = false;
  const auto close = [&] {
    if (!paragraph.empty()) body += fmt::format("<p>{}</p>\n", inline_html(paragraph));
    if (in_table) body += "</table>\n";
    paragraph.clear();
    in_table = false;
  };
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    std::smatch plot;
    const std::size_t marks = line.find_first_not_of('#');
    if (line.empty()) {
      close();
    } else if (line.starts_with('#') && marks != std::string::npos) {
      close();
      body += fmt::format("<h{0}>{1}</h{0}>\n", marks, inline_html(line.substr(marks + 1)));
    } else if (std::regex_match(line, plot, kPlot)) {
      close();
      body += find_plot(plot[1]);
    } else if (line.starts_with("|--")) {
      continue;
    } else if (line.starts_with('|')) {
      if (!in_table) {
        close();
        body += "<table>\n";
      }
      body += row_html(line, in_table ? "td" : "th");
      in_table = true;
    } else {
      if (in_table) close();
      paragraph += (paragraph.empty() ? "" : " ") + line;
    }
  }
  close();
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title><style>{}</style></head>\n"
      "<body>\n{}</body></html>\n",
      markup_text(title), kStyle, body);
}

}  // namespace weft::bench
