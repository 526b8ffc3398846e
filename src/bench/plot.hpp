// Plots with two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::bench {

enum class Marker { circle, square, triangle };

struct Curve {
  std::string name;
  std::string color;
  Marker marker = Marker::circle;
  bool dashed = false;
  std::vector<Vec2> points = {};  ///< those that are not positive are left out
  bool line = true;               ///< from point to point; else markers alone
};

struct Panel {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  double unresolved_below = 0;  ///< what lies below is shaded: it is not known so exactly
};

/// The panels side by side, three in a row, each with its own axes and names.
std::string log_log_svg(const std::vector<Panel>& panels);

}  // namespace weft::bench
