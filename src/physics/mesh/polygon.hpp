// Triangulates polygons with any number of corners.
#pragma once

#include <span>
#include <vector>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Cuts a simple, nearly flat polygon of n corners (convex or not) into n - 2 triangles of its own orientation by ear
/// clipping, and appends them. Self-crossing or collapsed polygons also give n - 2 triangles, of any shape. Time O(n²)
/// for usual polygons, O(n³) in the worst case.
void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles);

/// The same for a face of a file, whose coordinates have single precision. Corners along a straight side become corners
/// of triangles with an area. If needle triangles remain, flips edges inside the polygon until all are locally
/// Delaunay.
void triangulate_face(std::span<const Index> corners, std::span<const Vec3> positions,
                      std::vector<Triangle>& triangles);

}  // namespace weft::mesh
