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
  std::vector<Vec2> points = {};  ///< a point is drawn only if both coordinates are positive and finite
  bool line = true;               ///< whether lines connect the markers
};

struct Panel {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  double unresolved_below = 0;  ///< values below this are uncertain, and their region is shaded; 0: none
};

/// Draws the panels in rows of three, each with its own axes and legend.
std::string log_log_svg(const std::vector<Panel>& panels);

}  // namespace weft::bench
