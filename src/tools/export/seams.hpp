// Cuts surfaces along the edges at which the texture coordinates of the two triangles differ.
#pragma once

#include <array>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/materials.hpp"

namespace weft::exporter {

/// Triangles whose corners are places. A place is a vertex of the surface with one value of `uv`
/// and of `picture_uv`, so that panels are separate along their seams. The first place of vertex i
/// has the index i; additional places follow.
struct CutSurface {
  std::vector<Index> vertex_of;  ///< per place
  std::vector<Vec2> uv;          ///< per place; empty if the surface has none
  /// Per place, coordinates in the picture of its material: 0 to 1 from left to right and from bottom to top. Empty if
  /// `uv` already has these values, or there is no picture.
  std::vector<Vec2> picture_uv;
  std::vector<std::array<Index, 3>> triangles;  ///< indices of places

  bool is_cut(std::size_t vertices) const { return vertex_of.size() > vertices; }
};

/// Cuts a surface with `vertices` vertices.
CutSurface cut_at_seams(const frame::Surface& surface, const Materials& materials, std::size_t vertices);

}  // namespace weft::exporter
