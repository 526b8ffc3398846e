// Uniform Catmull-Rom splines through given points.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace weft {

/// Position of knot `i` of a spline with n ≥ 2 knots. `i`: from −1 to n, or to n + 1 if the spline is closed. Outside
/// of 0 to n − 1, a closed spline wraps around, and an open spline is extended linearly.
inline Vec3 spline_knot(const std::vector<Vec3>& knots, bool closed, int i) {
  const auto count = static_cast<int>(knots.size());
  const auto knot = [&](int k) -> const Vec3& { return knots[static_cast<std::size_t>(k)]; };
  if (closed) return knot((i + count) % count);
  if (i < 0) return 2 * knot(0) - knot(1);
  if (i >= count) return 2 * knot(count - 1) - knot(count - 2);
  return knot(i);
}

/// Position on the spline between knots i and i + 1. `s`: parameter, from 0 at knot i to 1 at knot i + 1.
inline Vec3 spline_point(const std::vector<Vec3>& knots, bool closed, int i, double s) {
  const Vec3 a = spline_knot(knots, closed, i - 1), b = spline_knot(knots, closed, i),
             c = spline_knot(knots, closed, i + 1), d = spline_knot(knots, closed, i + 2);
  return b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a)));
}

}  // namespace weft
