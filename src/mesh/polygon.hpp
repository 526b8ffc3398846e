// Triangles from polygons with any number of corners.
#pragma once

#include <span>
#include <vector>

#include "mesh/topology.hpp"

namespace weft::mesh {

/// Cuts a simple polygon, convex or not and nearly flat, into n - 2 triangles of its own orientation by clipping ears,
/// and appends them. Self-crossing or collapsed polygons give n - 2 triangles too, of whatever shape. Time O(n²) for
/// usual polygons, O(n³) at worst.
void triangulate_polygon(std::span<const Index> corners, std::span<const Vec3> positions,
                         std::vector<Triangle>& triangles);

/// The same of a face of a file, whose coordinates are of single precision: corners along a straight side stay corners
/// of triangles with an area, and where needles remain edges are turned until the triangles are as even as they can be.
void triangulate_face(std::span<const Index> corners, std::span<const Vec3> positions,
                      std::vector<Triangle>& triangles);

}  // namespace weft::mesh
