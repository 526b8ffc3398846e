// Distance of two convex polytopes by the algorithm of Gilbert, Johnson & Keerthi ("A fast procedure for computing the
// distance between complex objects in three-dimensional space", 1988).
#pragma once

#include <span>

#include "core/types.hpp"

namespace weft::collision {

/// Difference x_a − x_b [m] of the closest points of the convex hulls of two small sets of points; zero, up to
/// rounding, if the hulls meet. Each set has corners in any order, for example those of a triangle, an edge or a point.
/// A quad counts as the convex hull of its corners. Let `size` be the largest coordinate difference of the corners. The
/// length of the difference is never less than the distance of the hulls, and exceeds it by at most 5e-14 size, even
/// for needles. Along the difference, the gap between the hulls is less than their distance by at most 5e-14 size +
/// 1e-14 size² / distance (tests/collision/proximity/gjk_test.cpp).
Vec3 closest_convex(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace weft::collision
