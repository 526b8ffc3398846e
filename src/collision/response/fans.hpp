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

  /// Marks the middles of fans in which features without a common vertex were farther apart than `distance` at x
  /// [m]: those whose triangles, seen along the axis, have longer altitudes. Of two such features, one of each of
  /// two triangles, the closest points seen so are a vertex and a point of the other one. From the middle the way
  /// between leads to an edge opposite to it; from another vertex it crosses a neighbouring edge of the fan, or goes
  /// around the end of one. Both are no shorter than an altitude.
  void mark_open(double distance, std::span<const Vec3> x, std::span<std::uint8_t> vertices) const;

  /// Appends the edge-triangle pairs without certificate for the way from x_t0 to x_t1. `moved`: per vertex, a bound of
  /// its distance at either time from where it was at the reference [m]; `changed`: per vertex, whether x_t0 or x_t1 is
  /// another than in the last call.
  void find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                    std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing,
                    Certificates which = Certificates::all);

 private:
  using Edge = std::array<Index, 2>;
  /// Of a fan at the reference [m].
  struct Room {
    float slack;      // how far its vertices may move; negative: it is not certified as a whole
    float clearance;  // least altitude of its triangles along the axis, where it is
  };
  void add_fan(Index vertex, std::span<const Triangle> triangles);
  Room room_of(std::size_t fan, std::span<const Vec3> x) const;
  template <class Body>
  void for_each_pair(std::size_t fan, const Body& body) const;
  bool turns_once(std::size_t fan, const Vec3& axis, std::span<const Vec3> x) const;
  bool keeps_orientation(std::size_t fan, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const;
  std::span<const Index> around(std::size_t fan) const {
    return std::span(around_).subspan(begin_[fan], begin_[fan + 1] - begin_[fan]);
  }
  /// Empty for fans that are not closed.
  std::span<const Index> ring(std::size_t fan) const { return closed_[fan] ? around(fan) : std::span<const Index>(); }
  /// Edges opposite to the vertex, one of each triangle.
  std::size_t edge_count(std::size_t fan) const {
    return closed_[fan] ? around(fan).size() - 1 : around(fan).size() / 2;
  }
  Edge edge(std::size_t fan, std::size_t k) const {
    const Index* first = around_.data() + begin_[fan] + (closed_[fan] ? k : 2 * k);
    return {first[0], first[1]};
  }

  std::vector<Index> middle_;
  // Of closed fans the other vertices in their order around the middle, the first one once more as the last; of others
  // the ends of the edges opposite to it.
  std::vector<std::uint32_t> begin_{0};
  std::vector<Index> around_;
  std::vector<std::uint8_t> closed_;           // per fan
  std::vector<Room> rooms_;                    // per fan
  std::vector<std::uint8_t> has_certificate_;  // per fan: as a whole or pair by pair, when it was last looked at
};

}  // namespace weft::collision
