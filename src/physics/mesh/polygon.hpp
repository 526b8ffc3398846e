// Triangulates polygons with any number of corners.
#pragma once

#include <span>
#include <vector>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Cuts a simple, nearly flat polygon of n corners (convex or not) into n - 2 triangles of the same orientation by ear
/// clipping, and appends them. A polygon that crosses itself or has no area also gives n - 2
/// triangles, but of arbitrary shape. Fewer than three corners give none. Time O(n²) for usual
/// polygons, O(n³) in the worst case.
void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles);

/// As triangulate_polygon(), for a face from a file with coordinates of single precision. Avoids
/// triangles of nearly no area at corners along a straight side. If a triangle is a needle (height
/// below 5 % of its longest side), flips edges inside the polygon until all are locally Delaunay up
/// to rounding errors, in at most 100 rounds.
void triangulate_face(std::span<const Index> corners, std::span<const Vec3> positions,
                      std::vector<Triangle>& triangles);

}  // namespace weft::mesh
