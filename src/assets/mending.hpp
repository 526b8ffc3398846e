// Surfaces of other programs made into sheets of cloth: triangles that face the same way, edges of at most two of them.
#pragma once

#include <cstddef>
#include <string>

#include "assets/mesh_file.hpp"

namespace weft::assets {

/// What mend_sheet() did.
struct Mended {
  std::size_t doubled = 0;    ///< triangles on others with the same corners, taken out
  std::size_t turned = 0;     ///< turned to face as most around them
  std::size_t cut = 0;        ///< edges at which a third triangle, or one that cannot face likewise, was cut off
  std::size_t pieces = 0;     ///< that came off with them and were left out, being small
  double left_out = 0;        ///< their share of the area
  std::size_t collapsed = 0;  ///< edges that were collapsed or turned, of triangles too flat for the longest

  bool any() const { return doubled + turned + cut + collapsed > 0; }
  /// "12 triangles turned to face as those around them, 3 edges of more than two triangles cut open".
  std::string describe() const;
};

/// Makes the surface a sheet. Of triangles with the same corners one stays, as where surfaces are drawn from both
/// sides. What hangs together faces as most of its area does. Where more than two triangles share an edge the two that
/// lie flattest stay joined; what comes off as a small piece is left out, and other pieces end a little before the
/// edge. Edges of triangles that are flatter than a share `flattest` of the longest edge are collapsed if they are
/// short, and turned else, where that keeps the sheet and its UVs. UVs, colours and groups go along.
Mended mend_sheet(LoadedMesh& loaded, double flattest);

}  // namespace weft::assets
