// Repairs surfaces for use as sheets of cloth: consistent orientation, and at most two triangles at each edge.
#pragma once

#include <cstddef>
#include <string>

#include "film/assets/mesh_file.hpp"

namespace weft::assets {

/// The repairs by mend_sheet().
struct MendingReport {
  std::size_t doubled = 0;  ///< removed triangles that have the same corners as another triangle
  std::size_t turned = 0;   ///< triangles flipped to match those around them
  std::size_t cut = 0;      ///< edges of more than two triangles, or of two that face opposite ways; cut open
  std::size_t pieces = 0;  ///< removed: small detached pieces, and further triangles of an edge that cannot be detached
  double left_out = 0;     ///< area of `pieces` / area of the surface
  std::size_t collapsed = 0;  ///< collapsed or flipped edges of flat triangles

  bool any() const { return doubled + turned + cut + collapsed > 0; }
  /// Text such as "12 triangles flipped to match their neighbours, 3 edges of more than two triangles, or that face
  /// both ways, cut open".
  std::string describe() const;
};

/// Repairs a surface. `flattest`: minimum height of a triangle / longest edge of the mesh.
/// - Of triangles with the same corners, as in surfaces modelled with two sides, one is kept.
/// - Each connected piece is oriented like the majority of its area.
/// - If more than two triangles share an edge, the two that are most nearly coplanar stay joined; the others are
///   detached. Small detached pieces are removed; larger ones are moved slightly away from the edge.
/// - For each triangle whose height is below 1.1 · `flattest`, the shortest edge is collapsed if it is short enough,
///   else the longest edge is flipped, provided that the sheet stays manifold and its UVs stay continuous.
/// - Vertices that no triangle uses are removed.
/// Updates UVs, colours and groups.
MendingReport mend_sheet(LoadedMesh& loaded, double flattest);

}  // namespace weft::assets
