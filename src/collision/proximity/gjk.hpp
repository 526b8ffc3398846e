// Distance of two convex polygons by the algorithm of Gilbert, Johnson & Keerthi ("A fast procedure for computing the
// distance between complex objects in three-dimensional space", 1988; seed, "Distance Computation").
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/types.hpp"

namespace weft::collision {

/// Most corners of a polygon given to closest_convex.
inline constexpr std::size_t kMaxCorners = 8;

/// Closest points x_a = Σ weights_a x and x_b = Σ weights_b x of the convex hulls of two small sets of points.
struct ConvexClosest {
  std::array<double, kMaxCorners> weights_a, weights_b;  ///< ≥ 0, each summing to 1; zero past the corners
  Vec3 difference;                                       ///< x_a - x_b [m]; zero where the hulls meet
  double distance;                                       ///< its length [m]: never less than the distance of the hulls
  double lower_bound;                                    ///< never more [m]: a plane keeps the hulls so far apart
  int iterations;
};

/// Triangles, convex quads (warped ones count as the tetrahedron of their corners), edges and points: 1 to 8 corners in
/// any order. The distance is right to 5e-14 of the largest coordinate difference ("size") of the corners, needles
/// included; the lower bound likewise, less 1e-15 size² / distance (tests/collision/proximity/gjk_test.cpp).
ConvexClosest closest_convex(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace weft::collision
