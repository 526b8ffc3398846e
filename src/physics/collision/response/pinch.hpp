// Pinched cloth, to which obstacles leave no space: which triangles may intersect which obstacle, and how contacts push
// them back.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/proximity/feature_pair.hpp"
#include "physics/collision/proximity/surface_point.hpp"
#include "physics/collision/response/separating_plane.hpp"

namespace weft::collision {

/// The exempted cloth triangles, each with the limb of an obstacle from which it is exempt. (An obstacle without limbs
/// counts as one limb. A face between two limbs belongs to the limb of its first corner.) The triangle may intersect
/// this limb: no separating plane is required. update_exempted() removes a triangle from the set if it is apart from
/// the limb and back on its original side of the limb. Neighbours of a triangle of the set (triangles that share a
/// particle with it) are exempt from its limb, too, so that a limb that moves along the cloth does not drag the cloth
/// with it. Exception: if the common particle is on its original side of the limb, the neighbour is not exempt, so that
/// a limb that approaches does not exempt more and more of the cloth around it. update_exempted() adds a neighbour to
/// the set if it meets the limb or is on the wrong side of it. If two limbs overlap, the cloth is exempt from the limb
/// that first met it, and rests on the other limb. If the first limb retreats, the cloth returns to its original side
/// of that limb.
class PinchedPairs {
 public:
  struct Key {
    Triangle cloth;
    std::size_t body;
    Index limb;  ///< number within the body
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  /// Where the limb first met the cloth.
  struct Origin {
    int side = 0;  ///< +1: the cloth was outside the limb; −1: inside the body, or behind it if the body is an open
                   ///< surface; 0: not recorded
    std::vector<Triangle> faces;  ///< faces of the limb that first met the triangle; if there are none, those that
                                  ///< first met the exempted neighbour
  };

  /// Two points for a contact that pushes a particle, or a point of a cloth triangle, back to its original side of the
  /// limb. The vertices of `exit_pair` are a particle and the corners of a face of the limb, or the corners of a cloth
  /// triangle and one corner of the face that it crosses.
  struct Push {
    FeaturePair exit_pair;
    bool is_exit_clear = false;  ///< no obstacle contains the point to which the push leads (a closed container
                                 ///< in which the cloth was does not count)
  };

  PinchedPairs() = default;
  /// Vertices from `first_obstacle` on belong to obstacles. `body_of`, `limb_of`: per vertex; must outlive this
  /// object.
  PinchedPairs(Index first_obstacle, std::span<const std::size_t> body_of, std::span<const Index> limb_of)
      : first_obstacle_(first_obstacle), body_of_(body_of), limb_of_(limb_of) {}

  /// Whether side a is cloth and side b an obstacle. No other pairs are exempt.
  bool is_cloth_and_obstacle(const CornerPair& pair) const {
    return pair.a[0] < first_obstacle_ && pair.b[0] >= first_obstacle_;
  }
  /// Whether the pair needs no separating plane.
  bool exempts(const CornerPair& pair) const {
    if (origins_.empty() || !is_cloth_and_obstacle(pair)) return false;
    const Key of_pair = key(pair);
    return origins_.contains(of_pair) || std::ranges::any_of(pair.a, [&](Index particle) {
             const Corner corner{particle, of_pair.body, of_pair.limb};
             return particles_.contains(corner) && !returned_.contains(corner);
           });
  }
  /// Whether one of these vertices is a corner of an exempted triangle, and another one belongs to
  /// the limb from which this triangle is exempt.
  bool are_pinched(const std::array<Index, 4>& vertices) const;
  /// Exempts side a of the pair from the limb of side b. Call note_origins() afterwards, which records Origin::side.
  void add(const CornerPair& pair);
  void add(const Key& key, const Origin& origin) {
    origins_.emplace(key, origin);
    list_particles();
  }

  // In the functions below, `surfaces` contains all bodies, by number. Positions must be inside the bounds of the last
  // refit of `surfaces`.

  /// Completes the origin of triangles that add(pair) has exempted: records the side of their first corner at x_t0 [m].
  void note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0);

  /// Removes triangles that, at x [m], are apart from their limb and back on their original side of it. Adds triangles
  /// that share a particle with a triangle of the set, unless they are apart from the limb of that triangle and on its
  /// original side. `triangles`: of all surfaces, cloth first. `is_repeated`: whether the step was rejected before. In
  /// this case, neighbours are exempt on whichever side their common particle is, because keeping neighbours apart from
  /// the limb may have stretched the cloth.
  void update_exempted(std::span<const Triangle> triangles, const BroadPhase& surfaces, std::span<const Vec3> x,
                       bool is_repeated = false);

  /// Finds how to push pinched cloth at x [m] back to its original side. Pairs each corner of an exempted triangle
  /// whose height is below `max_height` [m] with the nearest point of the limb. (Height: signed distance from the limb,
  /// negative on the wrong side.) For a corner on the wrong side, only faces count whose normal is within 60° of the
  /// normal of the nearest face in its Origin (if there are such faces). If all corners of a triangle are on the right
  /// side but the triangle crosses a face, pairs the middle of that crossing with the face. Side a of each pair is the
  /// cloth; the normal points to the side where the cloth belongs.
  std::vector<Push> find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x, double max_height) const;

  bool empty() const { return origins_.empty(); }
  std::size_t size() const { return origins_.size(); }

  const std::map<Key, Origin>& origins() const { return origins_; }
  std::size_t body_of(Index vertex) const { return body_of_[vertex]; }
  bool is_obstacle(const Surface& surface) const { return surface.first_vertex >= first_obstacle_; }

  /// Saves or restores the set with its origins. Throws std::runtime_error if they do not fit these bodies.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  struct Corner {
    Index particle;
    std::size_t body;
    Index limb;
    friend auto operator<=>(const Corner&, const Corner&) = default;
  };

  void list_particles();
  Key key(const CornerPair& pair) const { return {pair.a, body_of(pair.b[0]), limb_of_[pair.b[0]]}; }
  CountsFace belongs_to_limb(Index limb) const {
    return [this, limb](const Triangle& face) { return limb_of_[face[0]] == limb; };
  }
  SurfacePoint nearest_on_limb(const Corner& corner, const BroadPhase& surfaces, std::span<const Vec3> x,
                               const Vec3& towards = Vec3::Zero()) const;
  bool is_on_side(int side, const Corner& corner, const SurfacePoint& nearest, const BroadPhase& surfaces,
                  std::span<const Vec3> x) const;
  bool is_on_its_side(const Corner& corner, const Origin& origin, const BroadPhase& surfaces,
                      std::span<const Vec3> x) const;
  std::vector<Triangle> faces_near(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  std::vector<Triangle> find_origin_faces(const Key& key, const Origin& beside, const BroadPhase& surfaces,
                                          std::span<const Vec3> x) const;
  bool is_apart(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const;
  bool is_exit_clear(const Vec3& place, const Vec3& outward, const Corner& corner, int side, const BroadPhase& surfaces,
                     std::span<const Vec3> x) const;

  Index first_obstacle_ = 0;
  std::span<const std::size_t> body_of_;
  std::span<const Index> limb_of_;
  std::map<Key, Origin> origins_;
  std::map<Corner, Origin> particles_;  // corners of the exempted triangles
  std::set<Corner> returned_;           // those on their original side at the last update_exempted()
};

}  // namespace weft::collision
