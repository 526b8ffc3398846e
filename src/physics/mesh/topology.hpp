// Connectivity of a triangle mesh: edges, components, and defects of an index list (a list of triangles).
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
  std::array<Index, 2> vertices{};         ///< lower index first
  std::array<Index, 2> triangles{-1, -1};  ///< the first two in ascending order; the second is -1 on the border
};

/// All edges of a triangle list, sorted by their vertex pair.
struct EdgeSet {
  std::vector<Edge> edges;
  std::vector<std::array<Index, 3>> of_triangle;  ///< indices into `edges`; edge k joins corners k and (k + 1) % 3
};

/// Collects each edge once. Vertex indices must be in range (see inspect()). Time O(n log n).
EdgeSet collect_edges(std::span<const Triangle> triangles);

/// Defects and open borders of an index list. Each list is in ascending order.
struct TopologyReport {
  std::vector<Index> out_of_range;                 ///< triangles with a vertex index that does not exist
  std::vector<Index> degenerate;                   ///< triangles that use a vertex twice
  std::vector<std::array<Index, 2>> non_manifold;  ///< edges of more than two triangles
  std::vector<std::array<Index, 2>> misoriented;  ///< edges that both of their triangles traverse in the same direction
  std::vector<std::array<Index, 2>> border;       ///< edges of one triangle

  /// Whether all triangles are valid, and every edge joins two equally oriented triangles or lies on the border.
  bool manifold() const {
    return out_of_range.empty() && degenerate.empty() && non_manifold.empty() && misoriented.empty();
  }
};

/// Checks any index list. Triangles that are out of range or degenerate do not contribute edges.
TopologyReport inspect(std::span<const Triangle> triangles, std::size_t vertex_count);

/// The number of the connected component of each vertex. Components are numbered in the order of
/// their first vertices; a vertex without triangles is a component.
std::vector<Index> components(std::span<const Triangle> triangles, std::size_t vertex_count);

}  // namespace weft::mesh
