// Places of grid lines whose spacing grows geometrically.
#pragma once

#include <cmath>

namespace weft {

/// Place of line `i` of `count`, from 0 for the first to 1 for the last, where the last spacing is `grading` times the
/// first and each a fixed multiple of the one before. With 1 they are even.
inline double graded_fraction(int i, int count, double grading) {
  if (grading == 1 || count < 3) return static_cast<double>(i) / (count - 1);
  const double log_ratio = std::log(grading) / (count - 2);
  return std::expm1(i * log_ratio) / std::expm1((count - 1) * log_ratio);
}

}  // namespace weft
