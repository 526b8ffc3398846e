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
#include "collision/proximity/surface_point.hpp"
#include "collision/response/certificate.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Triangles of cloth against limbs of obstacles. What is in here has no certificate: the triangle may be in the limb.
/// It stays until it is found apart from the limb and on the side that it came from. Nor have those that share a
/// particle with it: a limb that moves along the cloth that goes through it does not take hold of it, what comes to
/// meet it at the rim is in here from the next step on. Of two limbs that are in each other the cloth is in the one
/// that came upon it, and rests on the other: as that comes out again so does the cloth, on the side that it went in.
class PinchedPairs {
 public:
  struct Key {
    Triangle cloth;
    std::size_t body;
    Index limb;  ///< of the body
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  /// Where cloth was when it was exempted.
  struct Origin {
    int side = 0;  ///< of the surface: +1 outside, −1 inside or on the back of an open one; 0 not known
    std::vector<Triangle> faces;  ///< of the limb, that came upon it
  };

  /// The way back of a particle, or of a place of a triangle.
  struct Push {
    FeaturePair way;
    bool has_room = false;  ///< no obstacle is where it leads
  };

  PinchedPairs() = default;
  /// Vertices from `first_obstacle` on are those of obstacles; `body_of`, `limb_of`: of each vertex.
  PinchedPairs(Index first_obstacle, std::vector<std::size_t> body_of, std::vector<Index> limb_of)
      : first_obstacle_(first_obstacle), body_of_(std::move(body_of)), limb_of_(std::move(limb_of)) {}

  /// Whether the pair is one of cloth and obstacle; others are never exempted.
  bool may_hold(const CornerPair& pair) const { return pair.a[0] < first_obstacle_ && pair.b[0] >= first_obstacle_; }
  /// Whether the pair has no certificate.
  bool exempts(const CornerPair& pair) const {
    return !origins_.empty() && may_hold(pair) && std::ranges::any_of(pair.a, [&](Index particle) {
      return particles_.contains({particle, body_of(pair.b[0]), limb_of_[pair.b[0]]});
    });
  }
  /// Whether two features with these vertices are of such cloth and its limb.
  bool concern(const std::array<Index, 4>& vertices) const;
  void add(const CornerPair& pair);
  /// One whose origin is known.
  void add(const Key& key, const Origin& origin) {
    origins_.emplace(key, origin);
    list_particles();
  }

  // `surfaces`: of all bodies, by number; positions lie inside of the bounds of its last refit.

  /// Notes for pairs that were just exempted where their cloth was at x_t0 [m].
  void note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0);

  /// Lets go what is apart at x [m] and back on its side, so that it can be kept apart again, and takes in what is not
  /// of the triangles around. `triangles`: of all surfaces, cloth first.
  void renew(std::span<const Triangle> triangles, const BroadPhase& surfaces, std::span<const Vec3> x);

  /// How cloth gets back to its side at x [m]: each particle no more than `reach` [m] above the limb's surface along
  /// the way to the nearest point of it, inside of the limb of those faces that look as those that came upon it do now;
  /// or, where all corners of a triangle are on the right side and an edge or corner of the limb still sticks through,
  /// the place of that along the normal of the face that it crosses. Side a is the cloth; the normal points to the side
  /// that it belongs to.
  std::vector<Push> find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x, double reach) const;

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
  Key key(const CornerPair& pair) const { return {pair.a, body_of(pair.b[0]), limb_of_[pair.b[0]]}; }
  CountsFace is_of(Index limb) const {
    return [this, limb](const Triangle& face) { return limb_of_[face[0]] == limb; };
  }
  std::vector<Triangle> faces_near(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  bool is_apart(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  bool has_room(const Vec3& place, const Vec3& outward, const BroadPhase& surfaces, std::span<const Vec3> x) const;

  Index first_obstacle_ = 0;
  std::vector<std::size_t> body_of_;
  std::vector<Index> limb_of_;
  std::map<Key, Origin> origins_;
  struct Corner {
    Index particle;
    std::size_t body;
    Index limb;
    friend auto operator<=>(const Corner&, const Corner&) = default;
  };
  std::map<Corner, Origin> particles_;  // of these triangles
};

}  // namespace weft::collision
