// Cloth that obstacles leave no room: which triangles are exempted from non-penetration against which obstacle, and the
// way back out.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "collision/proximity/feature_pair.hpp"
#include "collision/response/certificate.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Triangles of cloth against whole obstacles. What is in here has no certificate: the triangle may be in the obstacle.
/// It stays until it is found apart from the obstacle and on the side that it came from.
class PinchedPairs {
 public:
  struct Key {
    Triangle cloth;
    std::size_t body;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  /// Where cloth was when it was exempted.
  struct Origin {
    int side = 0;  ///< of the surface: +1 outside, −1 inside or on the back of an open one; 0 not known
    Vec3 outward = Vec3::Zero();  ///< mean normal of the surface there, unit
  };

  PinchedPairs() = default;
  /// Vertices from `first_obstacle` on are those of obstacles; `body_of`: body of each vertex.
  PinchedPairs(Index first_obstacle, std::vector<std::size_t> body_of)
      : first_obstacle_(first_obstacle), body_of_(std::move(body_of)) {}

  /// Whether the pair is one of cloth and obstacle; others are never exempted.
  bool may_hold(const CornerPair& pair) const { return pair.a[0] < first_obstacle_ && pair.b[0] >= first_obstacle_; }
  bool holds(const CornerPair& pair) const {
    return !origins_.empty() && may_hold(pair) && origins_.contains(key(pair));
  }
  /// Whether a particle is a corner of a triangle that this obstacle pinches.
  bool touches(Index particle, std::size_t body) const { return particles_.contains({particle, body}); }
  /// Whether two features with these vertices are of such cloth and its obstacle.
  bool concern(const std::array<Index, 4>& vertices) const;
  void add(const CornerPair& pair) { origins_.emplace(key(pair), Origin{}); }
  /// One whose origin is known.
  void add(const Key& key, const Origin& origin) {
    origins_.emplace(key, origin);
    list_particles();
  }

  // `surfaces`: of all bodies, by number; positions lie inside of the bounds of its last refit.

  /// Notes for pairs that were just exempted where their cloth was at x_t0 [m].
  void note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0);

  /// Lets go what is apart at x [m] and back on its side, so that it can be kept apart again.
  void release(const BroadPhase& surfaces, std::span<const Vec3> x);

  /// How cloth gets back to its side at x [m]: each particle no more than `reach` [m] above the obstacle's surface
  /// along the way to the nearest point of it, inside of the obstacle of those faces that look where it came from; or,
  /// where all corners of a triangle are on the right side and an edge or corner of the obstacle still sticks through,
  /// the place of that along the normal of the face that it crosses. Side a is the cloth; the normal points to the side
  /// that it belongs to.
  std::vector<FeaturePair> find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x, double reach) const;

  bool empty() const { return origins_.empty(); }
  std::size_t size() const { return origins_.size(); }

  const std::map<Key, Origin>& origins() const { return origins_; }
  std::size_t body_of(Index vertex) const { return body_of_[vertex]; }
  bool is_obstacle(const Surface& surface) const { return surface.first_vertex >= first_obstacle_; }

  /// All that is held. Throws std::runtime_error where these cloths and obstacles cannot have it.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  void list_particles();
  Key key(const CornerPair& pair) const { return {pair.a, body_of(pair.b[0])}; }

  Index first_obstacle_ = 0;
  std::vector<std::size_t> body_of_;
  std::map<Key, Origin> origins_;
  std::map<std::pair<Index, std::size_t>, Origin> particles_;  // corners of these triangles, by obstacle
};

}  // namespace weft::collision
