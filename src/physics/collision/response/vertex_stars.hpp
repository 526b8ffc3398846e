// Keeps triangles that share exactly one vertex apart, vertex star by vertex star.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/response/certificate.hpp"

namespace weft::collision {

/// Two triangles (v, p, q) and (v, r, s) that share only the vertex v meet elsewhere only if the edge pq meets the
/// other triangle, or rs does. Both pairs of edge and triangle have no common vertex, so two separating planes keep the
/// triangles apart.
///
/// A vertex with six triangles has nine such pairs of triangles, so VertexStars tests a closed star (triangles all
/// around the vertex) as a whole where possible. If all its triangles, projected along one axis n, keep their
/// orientation during the step and go around the vertex once, they cover disjoint sectors, so no two meet outside their
/// common edges. The oriented area n·(e × f) of a moving triangle with edges e and f from the vertex is quadratic in
/// time, and positive if its Bernstein coefficients are (the cone test of Volino & Magnenat-Thalmann, "Efficient
/// Self-Collision Detection on Smoothly Discretized Surface Animations using Geometrical Shape Regularity", 1994, over
/// a time interval as in Tang et al., "ICCD: Interactive Continuous Collision Detection between Deformable Models using
/// Connectivity-Based Culling", 2009). A star that goes around once at the start does so throughout, because the angle
/// cannot jump. Open stars at borders have few pairs and are tested pair by pair.
class VertexStars {
 public:
  VertexStars() = default;
  /// `surfaces`: the deformable ones, with triangles counter-clockwise seen from the front.
  explicit VertexStars(std::span<const Surface> surfaces);

  /// Measures every star at x [m]: how far its vertices may move in any direction before it must be tested again.
  void set_reference(std::span<const Vec3> x);
  /// Makes the next find_failing() test all stars.
  void forget_tests();

  /// Sets `vertices` to 1 at the centres of stars in which features without a common vertex are farther apart than
  /// `distance` at x [m]; empty: at the reference. It suffices that all altitudes of the star's triangles, projected
  /// along its axis, exceed `distance`. Proof: the closest projected points of two such features of two triangles are a
  /// vertex and a point of the other triangle. The segment between them leads from the centre to an opposite edge; or,
  /// from another vertex, it crosses a neighbouring edge of the star or passes its end. In each case it is at least an
  /// altitude long.
  void mark_clear(double distance, std::span<const Vec3> x, std::span<std::uint8_t> vertices) const;

  /// Appends the edge-triangle pairs without a separating plane on the trajectory from x_t0 to x_t1. `moved`: per
  /// vertex, a bound of its distance from the reference at both times [m]. `changed`: per vertex, whether x_t0 or x_t1
  /// differs from the last call.
  void find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                    std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing,
                    PlaneKinds which = PlaneKinds::all);

 private:
  using Edge = std::array<Index, 2>;
  /// Measures of a star at the reference [m].
  struct StarMeasures {
    float slack;      // how far its vertices may move; negative: it cannot be certified as a whole
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
  /// Empty if the star is not closed.
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

  std::vector<Index> centres_;
  // Closed star: its other vertices in order around the centre, with the first repeated at the end. Open star: the ends
  // of the edges opposite to the centre.
  std::vector<std::uint32_t> begin_{0};
  std::vector<Index> ring_vertices_;
  std::vector<std::uint8_t> closed_;        // per star
  std::vector<StarMeasures> measures_;      // per star
  std::vector<std::uint8_t> is_separated_;  // per star: separated at the last test, as a whole or pair by pair
};

}  // namespace weft::collision
