// Repairs surfaces for use as sheets of cloth: consistent orientation, and at most two triangles per edge.
#pragma once

#include <cstddef>
#include <string>

#include "film/assets/mesh_file.hpp"

namespace weft::assets {

/// Report of mend_sheet().
struct MendingReport {
  std::size_t doubled = 0;    ///< removed triangles with the same corners as others
  std::size_t turned = 0;     ///< triangles flipped to match those around them
  std::size_t cut = 0;        ///< edges at which a third triangle, or one that cannot be oriented, was detached
  std::size_t pieces = 0;     ///< removed: small detached pieces, and third triangles that cannot be detached
  double left_out = 0;        ///< area of `pieces` / whole area
  std::size_t collapsed = 0;  ///< edges of needle triangles that were collapsed or flipped

  bool any() const { return doubled + turned + cut + collapsed > 0; }
  /// "12 triangles flipped to match their neighbours, 3 edges of more than two triangles, or that face both ways, cut
  /// open".
  std::string describe() const;
};

/// Repairs the surface:
/// - Of triangles with the same corners, as in surfaces modelled with two sides, one is kept.
/// - Each connected piece is oriented like the majority of its area.
/// - If more than two triangles share an edge, the two that are most nearly coplanar stay joined; the others are
///   detached. Small detached pieces are removed; larger ones are moved slightly away from the edge.
/// - Of triangles whose height is below 1.1 · `flattest` times the longest edge of the mesh, the shortest edge is
///   collapsed (if short enough) or the longest is flipped, if the sheet stays manifold and its UVs continuous.
/// - Vertices of faces without area that no other triangle has are removed.
/// UVs, colours and groups are updated.
MendingReport mend_sheet(LoadedMesh& loaded, double flattest);

}  // namespace weft::assets
