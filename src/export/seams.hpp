// Surfaces cut open where their places in a picture or pattern differ on both sides.
#pragma once

#include <array>
#include <vector>

#include "export/materials.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Triangles over places, each a vertex of the surface with one pair of texture coordinates: panels apart along their
/// seams. Place i is vertex i; those of further places follow.
struct CutSurface {
  std::vector<Index> vertex_of;  ///< per place
  std::vector<Vec2> uv;          ///< per place; empty where the surface has none
  /// Per place, in the picture of its material: 0 to 1 from left to right and from the bottom to the top. Empty where
  /// `uv` is that already, or there is no picture.
  std::vector<Vec2> picture_uv;
  std::vector<std::array<Index, 3>> triangles;  ///< of places

  bool is_cut(std::size_t vertices) const { return vertex_of.size() > vertices; }
};

/// By the corners of its triangles.
CutSurface cut_at_seams(const frame::Surface& surface, const Materials& materials, std::size_t vertices);

}  // namespace weft::exporter
