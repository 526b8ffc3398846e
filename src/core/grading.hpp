// Positions of grid lines whose spacing grows geometrically.
#pragma once

#include <cmath>

namespace weft {

/// Position of line `i` (0 to count − 1) of `count` lines (at least 2): 0 for the first line, 1 for the last. The last
/// spacing is `grading` times the first; the ratio of neighbouring spacings is constant. A `grading` of 1 spaces the
/// lines evenly.
inline double graded_fraction(int i, int count, double grading) {
  if (grading == 1 || count < 3) return static_cast<double>(i) / (count - 1);
  const double log_ratio = std::log(grading) / (count - 2);
  return std::expm1(i * log_ratio) / std::expm1((count - 1) * log_ratio);
}

}  // namespace weft
