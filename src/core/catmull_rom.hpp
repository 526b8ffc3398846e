// Uniform Catmull-Rom splines through places.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace weft {

/// Place number i of a spline, also beyond its ends: a closed one goes around, an open one goes straight on.
inline Vec3 spline_place(const std::vector<Vec3>& places, bool closed, int i) {
  const auto count = static_cast<int>(places.size());
  const auto place = [&](int k) -> const Vec3& { return places[static_cast<std::size_t>(k)]; };
  if (closed) return place((i + count) % count);
  if (i < 0) return 2 * place(0) - place(1);
  if (i >= count) return 2 * place(count - 1) - place(count - 2);
  return place(i);
}

/// Where the spline is between places i and i + 1, at s from 0 to 1.
inline Vec3 spline_point(const std::vector<Vec3>& places, bool closed, int i, double s) {
  const Vec3 a = spline_place(places, closed, i - 1), b = spline_place(places, closed, i),
             c = spline_place(places, closed, i + 1), d = spline_place(places, closed, i + 2);
  return b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a)));
}

}  // namespace weft
