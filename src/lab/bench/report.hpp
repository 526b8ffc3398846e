// Tables and plots of measurements, as text.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/stability.hpp"

namespace weft::bench {

/// Rows of equal length; the first one is the header.
using Table = std::vector<std::vector<std::string>>;

/// Comma-separated values. Fields with a comma, quote or line feed are quoted (RFC 4180).
std::string csv(const Table& table);
std::string markdown(const Table& table);

/// Destination of a link to `file` in the folder of the report. Bytes other than ASCII letters, digits and "-._~" are
/// percent-encoded (RFC 3986), because spaces and parentheses would end a destination in Markdown.
std::string link_to(const std::string& file);

/// Counts how often each verdict occurs.
class Tally {
 public:
  void add(Verdict verdict) { ++of_[static_cast<std::size_t>(verdict)]; }
  /// Number of verdicts Verdict::unbounded and Verdict::not_finite.
  int wrong() const;
  std::string text() const;

 private:
  std::array<int, kVerdicts> of_{};
};

/// The stability map as a table.
Table map_table(const std::vector<MapCell>& cells);
/// The stability map as SVG, with one panel per integrator. Stiffness increases upward, the time
/// step to the right. The colour of a cell is its verdict; the number in it is that of Newton
/// iterations per step.
std::string map_svg(const std::vector<MapCell>& cells);

}  // namespace weft::bench
