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
  std::vector<Vec2> points = {};  ///< points with a coordinate that is not positive and finite are not drawn
  bool line = true;               ///< whether lines connect the points; else only markers
};

struct Panel {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  double unresolved_below = 0;  ///< errors below this value are uncertain; the region is shaded
};

/// The panels in rows of three, each with its own axes and legend.
std::string log_log_svg(const std::vector<Panel>& panels);

}  // namespace weft::bench
