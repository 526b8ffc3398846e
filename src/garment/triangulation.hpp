// Flat meshes of pattern pieces.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::garment {

/// A triangulated flat region; the points of its outline come first, in their order.
struct FlatMesh {
  std::vector<Vec2> points;
  std::vector<mesh::Triangle> triangles;  ///< counter-clockwise
};

/// The constrained Delaunay triangulation of a simple polygon (counter-clockwise) with points inside, its edges kept.
/// Starts from clipped ears and inserts the points one by one, turning edges until each is locally Delaunay (Lawson,
/// "Software for C1 Surface Interpolation", 1977); what lies outside is never made. Deterministic.
FlatMesh triangulate(std::span<const Vec2> outline, std::span<const Vec2> inside);

/// Fills a polygon whose edges are about as long as `spacing` with a lattice of squares of that size along `warp` (a
/// unit vector) and at right angles to it, all cut along the same diagonal: six edges meet at each inner point, and
/// folds run smoothly. (With diagonals that alternate from row to row every sharp fold of a dress was corrugated, with
/// a period of two rows.) Points too near to the outline are left out; the strip along it is filled by the
/// triangulation.
FlatMesh mesh_panel(std::span<const Vec2> outline, const Vec2& warp, double spacing);

/// Signed area of a polygon [m²].
double polygon_area(std::span<const Vec2> outline);

/// The first two sides of a closed polygon that cross or touch without being neighbours, by their starts.
std::optional<std::pair<std::size_t, std::size_t>> self_crossing(std::span<const Vec2> outline);

}  // namespace weft::garment
