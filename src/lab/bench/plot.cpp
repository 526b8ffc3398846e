#include "lab/bench/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/markup.hpp"

namespace weft::bench {
namespace {

// Sizes of the panel, the plot area, and one row of the legend below it [pixels].
constexpr double kPanelWidth = 430, kLeft = 62, kTop = 34, kPlotWidth = 350, kPlotHeight = 260, kAxisHeight = 44,
                 kNameHeight = 15;
constexpr std::size_t kPanelsInARow = 3, kNamesInARow = 3;

/// A logarithmic axis from 10^low to 10^high, drawn from `start` over `length` [pixels].
struct PlotAxis {
  double low = 0, high = 1, start = 0, length = 1;
  double at(double value) const { return start + length * (std::log10(value) - low) / (high - low); }
};

bool is_drawn(const Vec2& point) {
  return point.x() > 0 && point.y() > 0 && point.allFinite();
}

// Axis that contains all points of the panel, with a margin at both ends.
PlotAxis fit(const Panel& panel, int coordinate, double start, double length) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Curve& curve : panel.curves) {
    for (const Vec2& point : curve.points) {
      if (!is_drawn(point)) continue;
      low = std::min(low, std::log10(point[coordinate]));
      high = std::max(high, std::log10(point[coordinate]));
    }
  }
  if (!(low <= high)) low = 0, high = 1;
  const double room = 0.06 * (high - low) + 0.05;
  return {low - room, high + room, start, length};
}

// Text of mantissa · 10^decade, such as 0.02, 5 or 200; for decades beyond ±3, such as 10^4 or 2·10^4.
std::string tick_name(double mantissa, int decade) {
  const double value = mantissa * std::pow(10.0, decade);
  if (decade >= -3 && decade <= 3) return fmt::format("{:g}", value);
  return fmt::format("{}10<tspan dy='-4' font-size='8'>{}</tspan>", mantissa == 1 ? "" : fmt::format("{:g}·", mantissa),
                     decade);
}

// Multiples of powers of ten that get a label, chosen so that an axis has about three labels or more, without overlap.
// `decades`: length of the axis [powers of ten].
std::vector<double> labelled_multiples(double decades) {
  if (decades < 0.5) return {1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9};
  if (decades < 1) return {1, 2, 3, 4, 5, 7};
  if (decades < 3) return {1, 2, 5};
  return {1};
}

// Grid lines at 1, 2 and 5 times the powers of ten, and labels at labelled_multiples(). If the axis
// is longer than kMaxLabelledDecades, only every second (third, ...) decade has labels.
std::string ticks(const PlotAxis& axis, bool vertical) {
  constexpr double kMaxLabelledDecades = 12;
  std::string text;
  const auto line = [&](double place, const char* color) {
    text += vertical ? fmt::format("<path d='M{:.1f} {:.1f}h{}' stroke='{}'/>\n", kLeft, place, kPlotWidth, color)
                     : fmt::format("<path d='M{:.1f} {:.1f}v{}' stroke='{}'/>\n", place, kTop, kPlotHeight, color);
  };
  const auto name = [&](double place, const std::string& words) {
    text += vertical
                ? fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>\n", kLeft - 5, place + 4, words)
                : fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", place,
                              kTop + kPlotHeight + 15, words);
  };
  const double decades = axis.high - axis.low;
  const std::vector<double> named = labelled_multiples(decades);
  const int every = static_cast<int>(std::ceil(decades / kMaxLabelledDecades));
  for (int decade = static_cast<int>(std::floor(axis.low)); decade <= axis.high; ++decade) {
    const auto inside = [&](double mantissa) {
      const double place = std::log10(mantissa) + decade;
      return place >= axis.low && place <= axis.high;
    };
    for (double mantissa : {1.0, 2.0, 5.0})
      if (inside(mantissa)) line(axis.at(mantissa * std::pow(10.0, decade)), mantissa == 1 ? "#c8c8c8" : "#eeeeee");
    for (double mantissa : named)
      if (inside(mantissa) && decade % every == 0)
        name(axis.at(mantissa * std::pow(10.0, decade)), tick_name(mantissa, decade));
  }
  return text;
}

std::string marker_at(Marker marker, double x, double y, const std::string& color) {
  switch (marker) {
    case Marker::circle:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.6' fill='{}'/>\n", x, y, color);
    case Marker::square:
      return fmt::format(
          "<rect x='{:.1f}' y='{:.1f}' width='6' height='6' fill='white' stroke='{}' stroke-width='1.6'/>\n", x - 3,
          y - 3, color);
    case Marker::triangle:
      return fmt::format("<path d='M{:.1f} {:.1f}l4.2 7.4h-8.4z' fill='{}'/>\n", x, y - 4.6, color);
  }
  return {};
}

std::string stroke_of(const Curve& curve) {
  return fmt::format("fill='none' stroke='{}' stroke-width='1.6'{}", curve.color,
                     curve.dashed ? " stroke-dasharray='5 3'" : "");
}

std::string draw(const Curve& curve, const PlotAxis& across, const PlotAxis& up) {
  std::string path, markers;
  for (const Vec2& point : curve.points) {
    if (!is_drawn(point)) continue;
    const double x = across.at(point.x()), y = up.at(point.y());
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
    markers += marker_at(curve.marker, x, y, curve.color);
  }
  if (path.empty()) return {};
  return (curve.line ? fmt::format("<path d='{}' {}/>\n", path, stroke_of(curve)) : std::string()) + markers;
}

std::string draw_names(const Panel& panel) {
  std::string text;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const std::size_t row = i / kNamesInARow, column = i % kNamesInARow;
    const double x = 8 + kPanelWidth / kNamesInARow * static_cast<double>(column);
    const double y = kTop + kPlotHeight + kAxisHeight + kNameHeight * (static_cast<double>(row) + 0.5);
    if (curve.line) text += fmt::format("<path d='M{:.1f} {:.1f}h24' {}/>\n", x, y, stroke_of(curve));
    text += fmt::format("{}<text x='{:.1f}' y='{:.1f}'>{}</text>\n", marker_at(curve.marker, x + 12, y, curve.color),
                        x + 29, y + 4, curve.name);
  }
  return text;
}

double height_of(const Panel& panel) {
  const std::size_t rows = (panel.curves.size() + kNamesInARow - 1) / kNamesInARow;
  return kTop + kPlotHeight + kAxisHeight + kNameHeight * static_cast<double>(rows) + 16;
}

std::string draw(const Panel& panel) {
  const PlotAxis across = fit(panel, 0, kLeft, kPlotWidth), up = fit(panel, 1, kTop + kPlotHeight, -kPlotHeight);
  std::string text =
      fmt::format("<text x='{}' y='20' font-size='14' font-weight='bold'>{}</text>\n", kLeft, markup_text(panel.title));
  if (panel.unresolved_below > 0 && std::log10(panel.unresolved_below) > up.low) {
    const double top = std::max(up.at(panel.unresolved_below), kTop);
    text += fmt::format("<rect x='{}' y='{:.1f}' width='{}' height='{:.1f}' fill='#f1ece0'/>\n", kLeft, top, kPlotWidth,
                        kTop + kPlotHeight - top);
  }
  text += ticks(across, false) + ticks(up, true);
  text += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#444444'/>\n", kLeft, kTop,
                      kPlotWidth, kPlotHeight);
  for (const Curve& curve : panel.curves) text += draw(curve, across, up);
  const double middle = kTop + 0.5 * kPlotHeight;
  return text + draw_names(panel) +
         fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", kLeft + 0.5 * kPlotWidth,
                     kTop + kPlotHeight + 31, panel.x_label) +
         fmt::format("<text x='14' y='{0:.1f}' text-anchor='middle' transform='rotate(-90 14 {0:.1f})'>{1}</text>\n",
                     middle, panel.y_label);
}

}  // namespace

std::string log_log_svg(const std::vector<Panel>& panels) {
  std::string body;
  double width = 0, top = 0;
  for (std::size_t first = 0; first < panels.size(); first += kPanelsInARow) {
    double row_height = 0;
    for (std::size_t i = first; i < std::min(panels.size(), first + kPanelsInARow); ++i) {
      const double left = kPanelWidth * static_cast<double>(i - first);
      body += fmt::format("<g transform='translate({} {})'>\n{}</g>\n", left, top, draw(panels[i]));
      row_height = std::max(row_height, height_of(panels[i]));
      width = std::max(width, left + kPanelWidth);
    }
    top += row_height;
  }
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' fill='white'/>\n{2}</svg>\n",
      width, top, body);
}

}  // namespace weft::bench
