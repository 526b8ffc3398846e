// Who touches whom on a triangle mesh: edges, and what is wrong with an index list.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

using Triangle = std::array<Index, 3>;
using Quad = std::array<Index, 4>;

/// An undirected edge and the triangles on its two sides.
struct Edge {
  std::array<Index, 2> vertices{};         ///< the lower index first
  std::array<Index, 2> triangles{-1, -1};  ///< in ascending order; the second is -1 on a border
};

/// All edges of a triangle list, sorted by their vertex pair.
struct EdgeSet {
  std::vector<Edge> edges;
  std::vector<std::array<Index, 3>> of_triangle;  ///< edge k of a triangle joins its corners k and (k + 1) % 3
  std::vector<Index> non_manifold;                ///< edges with more than two triangles; they keep the first two
};

/// Collects each edge once. Indices must be in range (see `inspect`); time O(n log n).
EdgeSet collect_edges(std::span<const Triangle> triangles);

/// What is wrong, or merely open, in an index list. The lists hold what is found, in ascending order.
struct TopologyReport {
  std::vector<Index> out_of_range;                 ///< triangles naming a vertex that is not there
  std::vector<Index> degenerate;                   ///< triangles naming a vertex twice
  std::vector<std::array<Index, 2>> non_manifold;  ///< edges of more than two triangles
  std::vector<std::array<Index, 2>> misoriented;   ///< edges whose two triangles run along it the same way
  std::vector<std::array<Index, 2>> border;        ///< edges of one triangle

  /// Every edge joins two, equally oriented triangles or lies on the border.
  bool manifold() const {
    return out_of_range.empty() && degenerate.empty() && non_manifold.empty() && misoriented.empty();
  }
};

/// Checks any index list; edges are judged among the triangles that are neither out of range nor degenerate.
TopologyReport inspect(std::span<const Triangle> triangles, std::size_t vertex_count);

/// Of each vertex the number of the component that it hangs together with, in the order of their first vertices.
std::vector<Index> components(std::span<const Triangle> triangles, std::size_t vertex_count);

}  // namespace weft::mesh
