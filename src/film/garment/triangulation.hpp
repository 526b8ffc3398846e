// Flat meshes of panels.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {

/// A triangulated flat region. `points` begins with the points of the outline, in their order.
struct FlatMesh {
  std::vector<Vec2> points;
  std::vector<mesh::Triangle> triangles;  ///< counter-clockwise
};

/// Constrained Delaunay triangulation of a simple counter-clockwise polygon with inner points. The edges of the polygon
/// are edges of triangles. Starts from the polygon cut into triangles by ear clipping, inserts the points one by one,
/// and flips edges until each is locally Delaunay (Lawson, "Software for C1 Surface Interpolation", 1977). No triangle
/// lies outside the polygon at any time. Deterministic.
FlatMesh triangulate(std::span<const Vec2> outline, std::span<const Vec2> inside);

/// Meshes a polygon whose edges are about `spacing` long. Most of the polygon becomes a lattice of squares with sides
/// `spacing`, along the unit vector `warp` and across it; a Delaunay triangulation fills the strip between lattice and
/// outline. All squares are cut along the same diagonal, so that six edges meet at each inner lattice point and folds
/// are smooth. With diagonals that alternate from row to row, every sharp fold is corrugated.
FlatMesh mesh_panel(std::span<const Vec2> outline, const Vec2& warp, double spacing);

/// Squared distance of the point `p` from the line between `a` and `b` [m²].
double distance_sq(const Vec2& p, const Vec2& a, const Vec2& b);

/// Area of a polygon [m²]; positive if it is counter-clockwise.
double polygon_area(std::span<const Vec2> outline);

/// Finds two sides of a closed polygon that cross or touch and are not adjacent. Returns the indices of their start
/// points, or nothing if there are no such sides.
std::optional<std::pair<std::size_t, std::size_t>> self_crossing(std::span<const Vec2> outline);

}  // namespace weft::garment
