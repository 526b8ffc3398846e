// Draws cloth as a smooth surface: splits each triangle in four, with the new vertices on cubic curves.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "film/render/shaded_mesh.hpp"

namespace weft::render {

/// Midpoint subdivision of a mesh. Triangle t becomes 4 t to 4 t + 3.
class Refinement {
 public:
  struct Edge {
    Index a, b;
  };

  /// Recomputes the subdivision if the triangles have changed. `vertices`: number of vertices of the coarse mesh.
  void update(std::span<const Triangle> coarse, std::size_t vertices);

  /// The midpoint of edge i is vertex `vertices` + i.
  std::span<const Edge> edges() const { return edges_; }
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  std::vector<Triangle> coarse_, triangles_;
  std::vector<Edge> edges_;
};

/// Midpoint of the cubic curve from a to b that is perpendicular to the normals at both ends (Vlachos et al., "Curved
/// PN Triangles", 2001). The normal at the midpoint is the normalised mean of both normals, because the paper's
/// quadratic normals oscillate along sharp folds; if both normals are opposite, it is `normal_a`. The midpoint is at
/// most `max_offset` [m] away from the middle of the straight edge, so that layers in contact do not intersect and
/// inaccurate normals cause no spikes.
struct Middle {
  Vec3 position, normal;
};
Middle middle(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b, double max_offset);

/// Value of `max_offset` [m] for cloth with this `thickness` [m]: the thickness, but at least 0.2 mm. For all built-in
/// fabrics, this is below half of the contact thickness, the gap that contacts keep between layers.
inline double max_midpoint_offset(double thickness) {
  return std::max(thickness, 2e-4);
}

}  // namespace weft::render
