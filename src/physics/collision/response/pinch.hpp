// Pinched cloth, squeezed between obstacles: which triangles may intersect which obstacle, and how they return.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/proximity/feature_pair.hpp"
#include "physics/collision/proximity/surface_point.hpp"
#include "physics/collision/response/certificate.hpp"

namespace weft::collision {

/// Set of cloth triangles, each exempt from one limb of an obstacle (an obstacle without limbs counts as one): the
/// triangle may intersect the limb, and no separating plane is required. A triangle is removed once it is apart from
/// the limb and back on its original side. Triangles that share a particle with an exempted one are exempt too, so that
/// a limb moving along the cloth does not drag the cloth with it. renew() adds those neighbours to the set that meet
/// the limb or are on its wrong side. If two limbs overlap, the cloth is exempt from the limb that reached it and rests
/// on the other. When the limb that reached it retreats, the cloth comes out on the side where it went in.
class PinchedPairs {
 public:
  struct Key {
    Triangle cloth;
    std::size_t body;
    Index limb;  ///< number within the body
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  /// State of the cloth when it was exempted.
  struct Origin {
    int side = 0;  ///< where it was: +1 outside the limb, −1 inside or behind an open surface; 0 not known
    std::vector<Triangle> faces;  ///< faces of the limb that reached the cloth
  };

  /// A pair of points for a contact that pushes a particle, or a point of a triangle, back to its side.
  struct Push {
    FeaturePair exit_pair;
    bool is_exit_clear = false;  ///< no obstacle lies at the exit
  };

  PinchedPairs() = default;
  /// Vertices from `first_obstacle` on belong to obstacles. `body_of`, `limb_of`: per vertex; must outlive it.
  PinchedPairs(Index first_obstacle, std::span<const std::size_t> body_of, std::span<const Index> limb_of)
      : first_obstacle_(first_obstacle), body_of_(body_of), limb_of_(limb_of) {}

  /// Whether side a is cloth and side b an obstacle. Other pairs are never exempt.
  bool is_cloth_and_obstacle(const CornerPair& pair) const {
    return pair.a[0] < first_obstacle_ && pair.b[0] >= first_obstacle_;
  }
  /// Whether the pair is exempt.
  bool exempts(const CornerPair& pair) const {
    return !origins_.empty() && is_cloth_and_obstacle(pair) && std::ranges::any_of(pair.a, [&](Index particle) {
      return particles_.contains({particle, body_of(pair.b[0]), limb_of_[pair.b[0]]});
    });
  }
  /// Whether two features with these vertices belong to pinched cloth and to the limb that pinches it.
  bool are_pinched(const std::array<Index, 4>& vertices) const;
  void add(const CornerPair& pair);
  /// Adds a triangle whose origin is known.
  void add(const Key& key, const Origin& origin) {
    origins_.emplace(key, origin);
    list_particles();
  }

  // Below, `surfaces` contains all bodies, by number. Positions must lie inside the bounds of its last refit.

  /// Records the origin, at x_t0 [m], of triangles that were just exempted.
  void note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0);

  /// Removes triangles that are apart at x [m] and back on their side, and adds neighbouring triangles that are not.
  /// `triangles`: of all surfaces, cloth first.
  void renew(std::span<const Triangle> triangles, const BroadPhase& surfaces, std::span<const Vec3> x);

  /// Finds how pinched cloth returns to its side at x [m]. Lists each corner of an exempted triangle whose height above
  /// the limb's surface (negative on the wrong side) is less than `max_height` [m], with the nearest point of the
  /// surface. For a corner on the wrong side, faces that point the same way as those that reached it take precedence.
  /// If all corners of a triangle are on the right side but it still crosses a face of the limb, lists the middle of
  /// that crossing, with the normal of the face. Side a is the cloth; the normal points to the side where the cloth
  /// belongs.
  std::vector<Push> find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x, double max_height) const;

  bool empty() const { return origins_.empty(); }
  std::size_t size() const { return origins_.size(); }

  const std::map<Key, Origin>& origins() const { return origins_; }
  std::size_t body_of(Index vertex) const { return body_of_[vertex]; }
  bool is_obstacle(const Surface& surface) const { return surface.first_vertex >= first_obstacle_; }

  /// Saves or restores all triangles and origins. Throws std::runtime_error if they do not fit these bodies.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  void list_particles();
  Key key(const CornerPair& pair) const { return {pair.a, body_of(pair.b[0]), limb_of_[pair.b[0]]}; }
  CountsFace belongs_to_limb(Index limb) const {
    return [this, limb](const Triangle& face) { return limb_of_[face[0]] == limb; };
  }
  std::vector<Triangle> faces_near(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  bool is_apart(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  bool is_exit_clear(const Vec3& place, const Vec3& outward, const BroadPhase& surfaces, std::span<const Vec3> x) const;

  Index first_obstacle_ = 0;
  std::span<const std::size_t> body_of_;
  std::span<const Index> limb_of_;
  std::map<Key, Origin> origins_;
  struct Corner {
    Index particle;
    std::size_t body;
    Index limb;
    friend auto operator<=>(const Corner&, const Corner&) = default;
  };
  std::map<Corner, Origin> particles_;  // corners of the exempted triangles
};

}  // namespace weft::collision
