// Tables and plots of what was measured, as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/stability.hpp"

namespace weft::bench {

/// Rows of equal length, the first one being the header.
using Table = std::vector<std::vector<std::string>>;

/// Comma separated; fields with a comma, quote or line feed in quotes (RFC 4180).
std::string csv(const Table& table);
std::string markdown(const Table& table);

Table map_table(const std::vector<MapCell>& cells);
/// The map as a picture: a panel for each integrator, stiffness upward, step to the right, colored by verdict.
std::string map_svg(const std::vector<MapCell>& cells);

}  // namespace weft::bench
