// A report as one page that any browser opens.
#pragma once

#include <functional>
#include <string>

namespace weft::bench {

/// The text of a plot by its name in the report.
using FindPlot = std::function<std::string(const std::string& name)>;

/// The Markdown that reports consist of (headings, paragraphs, `code`, **strong**, tables, plots) as HTML. Plots are
/// part of the page, which needs no other file.
std::string html_page(const std::string& title, const std::string& markdown, const FindPlot& find_plot);

}  // namespace weft::bench
