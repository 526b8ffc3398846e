// Proves for each vertex star that its triangles with exactly one common vertex stay apart. The star of a vertex is the
// set of triangles around it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/response/separating_plane.hpp"

namespace weft::collision {

/// Two triangles (v, p, q) and (v, r, s) with only the vertex v in common meet elsewhere only if the edge pq meets the
/// other triangle, or rs does. In each of these two cases, edge and triangle have no common vertex. So two separating
/// planes, one for each case, prove that the triangles stay apart.
///
/// In a star of six triangles, nine pairs of triangles have only the centre in common. VertexStars therefore tests a
/// closed star (triangles all around the centre) as a whole if possible: all its triangles, projected along one axis n,
/// must keep their orientation during the step and go around the centre once. They then cover disjoint sectors, so no
/// two meet outside their common edges. The oriented area n·(e × f) of a moving triangle with edges e and f from the
/// centre is quadratic in time, and positive if its Bernstein coefficients are (the cone test of Volino &
/// Magnenat-Thalmann, "Efficient Self-Collision Detection on Smoothly Discretized Surface Animations using Geometrical
/// Shape Regularity", 1994, over a time interval as in Tang et al., "ICCD: Interactive Continuous Collision Detection
/// between Deformable Models using Connectivity-Based Culling", 2009). A star that goes around once at the start goes
/// around once throughout, because its total angle is continuous in time. Open stars, at borders, have few pairs and
/// are tested pair by pair; so are closed stars that fail this test.
class VertexStars {
 public:
  /// `surfaces`: the deformable ones, with triangles counter-clockwise seen from the front.
  explicit VertexStars(std::span<const Surface> surfaces);

  /// Makes x [m] the reference. Measures how far the vertices of each closed star may move from
  /// there, in any direction, before the star must be tested again.
  void set_reference(std::span<const Vec3> x);
  /// Makes the next find_failing() test all stars.
  void forget_tests();

  /// Sets the flag in `vertices` to 1 for centres of clear stars. In a clear star, features without a common vertex are
  /// farther apart than `distance` [m] at x [m] (at the reference if x is empty). A closed star is clear if all
  /// altitudes of its triangles, projected along its axis, exceed `distance`. Open stars are never marked. Proof: in
  /// the projection, the closest points of two such features of two triangles are a vertex and a point of the other
  /// triangle. If this vertex is the centre, the segment between them leads from the centre to an opposite edge. If it
  /// is another vertex, the segment crosses a neighbouring edge of the star or passes the end of that edge. In each
  /// case, the segment is at least as long as an altitude.
  void mark_clear(double distance, std::span<const Vec3> x, std::span<std::uint8_t> vertices) const;

  /// Appends the pairs of an edge and a triangle without a separating plane on the trajectory from x_t0 to x_t1.
  /// `moved`: per vertex, a bound of its distance from the reference at both times [m]. `changed`: per vertex, whether
  /// x_t0 or x_t1 differs from that of the last call.
  void find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                    std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing,
                    PlaneKinds which = PlaneKinds::all);

 private:
  using Edge = std::array<Index, 2>;
  /// Measures of a star at the reference [m].
  struct StarMeasures {
    float slack;      // how far its vertices may move before it is tested again; negative: it is always tested
    float clearance;  // smallest altitude of its triangles, projected along the axis; negative if `slack` is
  };
  void add_star(Index vertex, std::span<const Triangle> triangles);
  StarMeasures measure_star(std::size_t star, std::span<const Vec3> x) const;
  template <class Body>
  void for_each_pair(std::size_t star, const Body& body) const;
  bool turns_once(std::size_t star, const Vec3& axis, std::span<const Vec3> x) const;
  bool keeps_orientation(std::size_t star, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const;
  std::span<const Index> other_vertices(std::size_t star) const {
    return std::span(ring_vertices_).subspan(begin_[star], begin_[star + 1] - begin_[star]);
  }
  /// Other vertices of a closed star, see ring_vertices_; empty if the star is open.
  std::span<const Index> ring(std::size_t star) const {
    return closed_[star] ? other_vertices(star) : std::span<const Index>();
  }
  /// Edges opposite to the centre, one per triangle.
  std::size_t edge_count(std::size_t star) const {
    return closed_[star] ? other_vertices(star).size() - 1 : other_vertices(star).size() / 2;
  }
  Edge edge(std::size_t star, std::size_t k) const {
    const Index* first = ring_vertices_.data() + begin_[star] + (closed_[star] ? k : 2 * k);
    return {first[0], first[1]};
  }

  std::vector<Index> centres_;  // per star
  // Vertices of all stars but the centres; star s begins at begin_[s]. Closed star: its other vertices in order around
  // the centre, with the first repeated at the end. Open star: the ends of the edges opposite to the centre.
  std::vector<std::uint32_t> begin_{0};
  std::vector<Index> ring_vertices_;
  std::vector<std::uint8_t> closed_;        // per star
  std::vector<StarMeasures> measures_;      // per star
  std::vector<std::uint8_t> is_separated_;  // per star: separated at the last test, as a whole or pair by pair
};

}  // namespace weft::collision
