// Repairs surfaces for use as sheets of cloth: consistent orientation, and at most two triangles at each edge.
#pragma once

#include <cstddef>
#include <string>

#include "film/assets/mesh_file.hpp"

namespace weft::assets {

/// Counts of the repairs by mend_sheet().
struct MendingReport {
  std::size_t duplicates = 0;  ///< removed triangles that have the same corners as another triangle
  std::size_t flipped = 0;     ///< triangles flipped to match those around them
  std::size_t cut_edges = 0;   ///< edges cut open: non-manifold or between opposite orientations
  std::size_t pieces = 0;      ///< removed small pieces, and removed triangles that could not be detached
  double left_out = 0;         ///< area of `pieces` / area of the surface
  std::size_t collapsed = 0;   ///< collapsed or flipped edges of flat triangles

  bool any() const { return duplicates + flipped + cut_edges + collapsed > 0; }
  /// Text such as "12 triangles flipped to match their neighbours, 3 edges of more than two triangles, or that face
  /// both ways, cut open".
  std::string describe() const;
};

/// Repairs a surface. `flattest`: minimum height of a triangle, relative to the longest edge of the mesh.
/// - If several triangles have the same corners, as in surfaces modelled with two sides, keeps one of them.
/// - Gives all triangles of a connected piece the orientation that most of its area has.
/// - If more than two triangles share an edge, joins them in pairs, the most nearly coplanar ones first, and detaches
///   the others. Also detaches pairs of opposite orientation. Removes small detached pieces, and moves larger ones
///   slightly away from the edge. Removes triangles that cannot be detached.
/// - A triangle is flat if its height is below 1.1 · `flattest` · (longest edge of the mesh). Collapses the shortest
///   edge of a flat triangle if it is short enough, otherwise flips the longest edge, provided that the sheet stays
///   manifold and its UVs stay continuous.
/// - Removes vertices that no triangle uses.
/// Updates UVs, colours and groups.
MendingReport mend_sheet(LoadedMesh& loaded, double flattest);

}  // namespace weft::assets
