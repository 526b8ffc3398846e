// Tables and plots of what was measured, as text.
#pragma once

#include <array>
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

/// How often each verdict was given.
class Tally {
 public:
  void add(Verdict verdict) { ++of_[static_cast<std::size_t>(verdict)]; }
  /// With more energy than there can be and no word of it, or not finite.
  int wrong() const;
  std::string text() const;

 private:
  std::array<int, kVerdicts> of_{};
};

Table map_table(const std::vector<MapCell>& cells);
/// The map as a picture: a panel for each integrator, stiffness upward, step to the right, colored by verdict.
std::string map_svg(const std::vector<MapCell>& cells);

}  // namespace weft::bench
