// A report as one self-contained HTML page.
#pragma once

#include <functional>
#include <string>

namespace weft::bench {

/// Returns the SVG text of the plot to which the report refers with `link`; see link_to().
using FindPlot = std::function<std::string(const std::string& link)>;

/// Converts the Markdown subset of the reports (headings, paragraphs, `code`, **strong**, tables, plots) to HTML. Plots
/// are embedded, so that the page needs no other file.
std::string html_page(const std::string& title, const std::string& markdown, const FindPlot& find_plot);

}  // namespace weft::bench
