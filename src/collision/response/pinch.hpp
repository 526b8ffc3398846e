// Cloth that obstacles leave no room: which triangles have been given up to which obstacle, and the way back out.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "collision/response/certificate.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// The point of a surface nearest to p.
struct SurfacePoint {
  Triangle face{};
  std::array<double, 3> weights{};  ///< of the face's corners
  Vec3 normal = Vec3::UnitZ();      ///< unit, outward: away from the inside along the line to p
  double height = 0;                ///< distance of p [m], negative inside
};

/// Inside and outside, or back and front, are told by the angle-weighted normal of all faces that meet in the nearest
/// point (Bærentzen & Aanæs, "Signed Distance Computation Using the Angle Weighted Pseudonormal", 2005). `triangles`:
/// counter-clockwise from outside, not empty. Faces whose normal points less than 60 degrees away from `towards` are
/// looked at alone, where there are any; zero for all.
SurfacePoint nearest_point(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> x,
                           const Vec3& towards = Vec3::Zero());

/// Where an edge of one triangle goes through the other: the weights of the corners of `a`, on average over the ends of
/// the segment that the two have in common; empty if they do not cross.
std::optional<std::array<double, 3>> find_crossing(const Triangle& a, const Triangle& b, std::span<const Vec3> x);

/// A point of pinched cloth and one of the obstacle, to be pushed apart.
struct PinchTouch {
  std::array<Index, 4> vertices{};
  std::array<double, 4> weights{};  ///< of the cloth > 0, of the obstacle < 0
  Vec3 normal;                      ///< unit, to the side that the cloth belongs to
  double height = 0;                ///< along the normal [m]; negative on the wrong side
};

/// Triangles of cloth against whole obstacles. What is in here has no certificate: the triangle may be in the obstacle.
/// It stays until it is found apart from the obstacle and on the side that it came from.
class PinchedPairs {
 public:
  struct Key {
    Triangle cloth;
    std::size_t body;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  /// Where cloth was when it was given up.
  struct Origin {
    int side = 0;  ///< of the surface: +1 outside, −1 inside or on the back of an open one; 0 not known
    Vec3 outward = Vec3::Zero();  ///< mean normal of the surface there, unit
  };

  PinchedPairs() = default;
  /// Vertices from `first_obstacle` on are those of obstacles; `body_of`: body of each vertex.
  PinchedPairs(Index first_obstacle, std::vector<std::size_t> body_of)
      : first_obstacle_(first_obstacle), body_of_(std::move(body_of)) {}

  /// Whether the pair is one of cloth and obstacle; others are never given up.
  bool may_hold(const CornerPair& pair) const { return pair.a[0] < first_obstacle_ && pair.b[0] >= first_obstacle_; }
  bool holds(const CornerPair& pair) const {
    return !origins_.empty() && may_hold(pair) && origins_.contains(key(pair));
  }
  /// Whether a particle is a corner of a triangle given up to this obstacle.
  bool touches(Index particle, std::size_t body) const { return particles_.contains({particle, body}); }
  /// Whether two features with these vertices are of such cloth and its obstacle.
  bool concern(const std::array<Index, 4>& vertices) const;
  void add(const CornerPair& pair) { origins_.emplace(key(pair), Origin{}); }

  /// Notes for pairs that were just given up where their cloth was at x_t0 [m]. `surfaces`: per body.
  void note_origins(std::span<const Surface> surfaces, std::span<const Vec3> x_t0);

  /// Lets go what is apart at x [m] and back on its side, so that it can be kept apart again.
  void release(std::span<const Surface> surfaces, std::span<const Vec3> x);

  /// How cloth gets back to its side at x [m]: each particle no more than `reach` [m] above the obstacle's surface
  /// along the way to the nearest point of it, inside of the obstacle of those faces that look where it came from; or,
  /// where all corners of a triangle are on the right side and an edge or corner of the obstacle still sticks through,
  /// the place of that along the normal of the face that it crosses.
  std::vector<PinchTouch> find_touches(std::span<const Surface> surfaces, std::span<const Vec3> x, double reach) const;

  bool empty() const { return origins_.empty(); }
  std::size_t size() const { return origins_.size(); }

  const auto& origins() const { return origins_; }

  /// All that is held. Throws std::runtime_error where these cloths and obstacles cannot have it.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  void list_particles();
  Key key(const CornerPair& pair) const { return {pair.a, body_of_[static_cast<std::size_t>(pair.b[0])]}; }

  Index first_obstacle_ = 0;
  std::vector<std::size_t> body_of_;
  std::map<Key, Origin> origins_;
  std::map<std::pair<Index, std::size_t>, Origin> particles_;  // corners of these triangles, by obstacle
};

}  // namespace weft::collision
