// Flat meshes of pattern pieces.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {

/// A triangulated flat region. The points of its outline come first, in their order.
struct FlatMesh {
  std::vector<Vec2> points;
  std::vector<mesh::Triangle> triangles;  ///< counter-clockwise
};

/// Constrained Delaunay triangulation of a simple counter-clockwise polygon with inner points; keeps the polygon's
/// edges. Starts from clipped ears, inserts the points one by one and flips edges until each is locally Delaunay
/// (Lawson, "Software for C1 Surface Interpolation", 1977); triangles outside the polygon never exist. Deterministic.
FlatMesh triangulate(std::span<const Vec2> outline, std::span<const Vec2> inside);

/// Fills a polygon whose edges are about as long as `spacing` with a lattice of squares of that size along `warp` (a
/// unit vector) and across it. All squares are cut along the same diagonal, so that six edges meet at each inner point
/// and folds run smoothly (measured: diagonals that alternate from row to row corrugate every sharp fold). Lattice
/// points too near to the outline are left out; the triangulation fills the strip along it.
FlatMesh mesh_panel(std::span<const Vec2> outline, const Vec2& warp, double spacing);

/// Area of a polygon [m²]; positive if it is counter-clockwise.
double polygon_area(std::span<const Vec2> outline);

/// Indices of the start points of the first two sides of a closed polygon that cross or touch without being neighbours.
std::optional<std::pair<std::size_t, std::size_t>> self_crossing(std::span<const Vec2> outline);

}  // namespace weft::garment
