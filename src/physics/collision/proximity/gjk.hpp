// Distance of two convex polytopes by the algorithm of Gilbert, Johnson & Keerthi ("A fast procedure for computing the
// distance between complex objects in three-dimensional space", 1988).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/types.hpp"

namespace weft::collision {

/// Maximum number of corners of a set given to closest_convex.
inline constexpr std::size_t kMaxCorners = 8;

/// Closest points x_a = Σ weights_a x and x_b = Σ weights_b x of the convex hulls of two small sets of points.
struct ConvexClosest {
  std::array<double, kMaxCorners> weights_a, weights_b;  ///< ≥ 0; sum 1; zero past the last corner
  Vec3 difference;                                       ///< x_a - x_b [m]; zero, up to rounding, if the hulls meet
  double distance;     ///< length of `difference` [m]; never less than the true distance
  double lower_bound;  ///< never more than the true distance [m]; some plane separates the hulls by this gap
  int iterations;
};

/// Each set has 1 to 8 corners in any order, for example those of a triangle, an edge or a point. A
/// quad counts as the convex hull of its corners. Let `size` be the largest coordinate difference
/// of the corners. The error of the distance is at most 5e-14 size, even for needles. The lower
/// bound is less than the distance by at most 5e-14 size + 1e-15 size² / distance
/// (tests/collision/proximity/gjk_test.cpp).
ConvexClosest closest_convex(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace weft::collision
