// Surfaces cut open where their places in a picture or pattern differ on both sides.
#pragma once

#include <array>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Triangles over places, each a vertex of the surface with one pair of texture coordinates: panels apart along their
/// seams.
struct CutSurface {
  std::vector<Index> vertex_of;                 ///< per place
  std::vector<Vec2> uv;                         ///< per place; empty where the surface has none
  std::vector<std::array<Index, 3>> triangles;  ///< of places
};

/// By the corners of its triangles; without any all vertices are places, in their order.
CutSurface cut_at_seams(const frame::Surface& surface);

}  // namespace weft::exporter
