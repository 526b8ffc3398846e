// Triangles that share exactly one vertex, kept apart fan by fan.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "collision/response/certificate.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Two triangles (v, p, q) and (v, r, s) that share the vertex v alone meet elsewhere only if the edge pq meets the
/// other triangle, or rs does: both pairs of edge and triangle have no common vertex, and a certificate each keeps the
/// two apart.
///
/// There are nine such pairs around a vertex with six triangles, so a whole closed fan is certified at once where that
/// is possible: if all its triangles, projected along one axis n, keep their orientation throughout the step and go
/// around the vertex once, then they cover disjoint sectors, and no two meet outside the edges they share. The oriented
/// area n·(e × f) of a moving triangle is quadratic in time, and positive where its Bernstein coefficients are (the
/// cone test of Volino & Magnenat-Thalmann, "Efficient Self-Collision Detection on Smoothly Discretized Surface
/// Animations using Geometrical Shape Regularity", 1994, over a time interval as in Tang et al., "ICCD: Interactive
/// Continuous Collision Detection between Deformable Models using Connectivity-Based Culling", 2009). Going around once
/// at the start is going around once for good, since the angle cannot jump. Open fans at borders have few pairs and
/// no such argument; they are certified pair by pair.
class Fans {
 public:
  Fans() = default;
  /// `surfaces`: the deformable ones; their triangles are counter-clockwise from the front.
  explicit Fans(std::span<const Surface> surfaces);

  /// Measures every fan at x [m]: how far its vertices may move from there, in any way, before it has to be looked at.
  void set_reference(std::span<const Vec3> x);

  /// Marks the middles of fans in which features without a common vertex were farther apart than `distance` [m] at the
  /// reference: moved towards each other by half of what they are apart, they would meet, and while no vertex moves as
  /// far as its fan allows none do.
  void mark_open(double distance, std::span<std::uint8_t> vertices) const;

  /// Appends the edge-triangle pairs without certificate for the way from x_t0 to x_t1. `moved`: per vertex, a bound of
  /// its distance at either time from where it was at the reference [m]; `changed`: per vertex, whether x_t0 or x_t1 is
  /// another than in the last call.
  void find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                    std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing);

 private:
  using Edge = std::array<Index, 2>;
  void add_fan(Index vertex, std::span<const Triangle> triangles);
  float slack_of(std::size_t fan, std::span<const Vec3> x) const;
  template <class Body>
  void for_each_pair(std::size_t fan, const Body& body) const;
  bool turns_once(std::size_t fan, const Vec3& axis, std::span<const Vec3> x) const;
  bool keeps_orientation(std::size_t fan, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const;
  std::span<const Index> ring(std::size_t fan) const {
    return std::span(ring_).subspan(ring_begin_[fan], ring_begin_[fan + 1] - ring_begin_[fan]);
  }
  std::span<const Edge> edges(std::size_t fan) const {
    return std::span(edges_).subspan(edges_begin_[fan], edges_begin_[fan + 1] - edges_begin_[fan]);
  }

  // Closed fans: the vertex in the middle, and the others in their order around it.
  std::vector<Index> middle_;
  std::vector<std::size_t> ring_begin_{0};
  std::vector<Index> ring_;
  std::vector<float> slack_;                   // per fan [m]; negative: not certified as a whole at the reference
  std::vector<std::uint8_t> has_certificate_;  // per fan: as a whole or pair by pair, when it was last looked at
  // Of the triangles of each fan, closed or not: the edges opposite to the vertex.
  std::vector<Edge> edges_;
  std::vector<std::size_t> edges_begin_{0};  // by fan
};

}  // namespace weft::collision
