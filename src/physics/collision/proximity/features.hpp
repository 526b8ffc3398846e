// Assigns each vertex and edge to one triangle that owns it, and lists the triangles around vertices and edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"

namespace weft::collision {

/// The lowest-numbered triangle that contains a vertex or edge owns it. A loop over pairs of triangles that uses only
/// the vertices and edges that each triangle owns visits each pair of features once (Curtis, Tamstorf & Manocha, "Fast
/// Collision Detection for Deformable Models using Representative-Triangles", 2008).
class Features {
 public:
  Features() = default;

  /// `triangles`: of all surfaces, in their global numbering; must outlive this object. Surfaces share no vertices.
  Features(std::span<const Triangle> triangles, Index vertex_count);

  std::span<const Triangle> triangles() const { return triangles_; }
  const Triangle& triangle(Index t) const { return triangles_[t]; }

  /// Bit c (0 to 2) is set if triangle t owns its corner c. Bit 3 + c is set if it owns the edge
  /// from corner c to corner c + 1 (corner 3 is corner 0).
  std::uint8_t owned(Index t) const { return owned_[t]; }

  /// Vertices opposite to the edge from corner c to corner c + 1, one for each triangle at that
  /// edge. Triangle t must own the edge.
  std::span<const Index> apexes(Index t, std::size_t c) const {
    const auto edge = static_cast<std::size_t>(edge_[t][c]);
    return std::span(apexes_).subspan(at(apexes_begin_[edge]), at(apexes_begin_[edge + 1] - apexes_begin_[edge]));
  }

  /// The other triangle at the edge from corner c to corner c + 1. −1 if triangle t does not own the edge, or if one
  /// triangle or more than two contain it.
  Index across(Index t, std::size_t c) const { return across_[t][c]; }

  /// Triangles at a vertex, lowest number first.
  std::span<const Index> triangles_at(Index vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(around_).subspan(at(around_begin_[v]), at(around_begin_[v + 1] - around_begin_[v]));
  }

  /// Sorted pairs of triangles a < b with a common edge, with a in [first, first + count).
  std::vector<TrianglePair> hinges(Index first, Index count) const;

 private:
  void collect_triangles_at_vertices(Index vertex_count);
  void own_edges();

  std::span<const Triangle> triangles_;
  std::vector<std::uint8_t> owned_;
  std::vector<std::array<Index, 3>> edge_;  // by triangle and corner: number of the edge, if owned
  std::vector<std::array<Index, 3>> across_;
  std::vector<Index> apexes_begin_;  // by edge
  std::vector<Index> apexes_;
  std::vector<Index> around_begin_;
  std::vector<Index> around_;
};

inline bool has_vertex(const Triangle& triangle, Index vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace weft::collision
