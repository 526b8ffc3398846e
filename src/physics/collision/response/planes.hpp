// Separating planes of candidate pairs, kept from step to step.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/numerics.hpp"
#include "core/types.hpp"
#include "physics/collision/hierarchy/lanes.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/response/carried_starts.hpp"
#include "physics/collision/response/separating_plane.hpp"

namespace weft::collision {

/// Stores, for each pair of a list of candidate pairs (the watched pairs), a direction and the gap along this direction
/// at the reference, the positions of the last watch(). The motion of a triangle is the largest distance of its corners
/// from the reference. The gap shrinks by at most the sum of the motions of both triangles. If this sum is less than
/// the gap, the pair counts as separated without a test, so cloth that rests on cloth costs one comparison per pair and
/// step. A pair also counts as separated without a test if its trajectory has not changed since its last successful
/// test. This saves time while pairs are pushed apart, because each round moves few vertices.
class Planes {
 public:
  /// Vertices from `obstacles_from` on belong to obstacles.
  explicit Planes(std::span<const Triangle> triangles, Index obstacles_from = 0)
      : triangles_(triangles), obstacles_from_(obstacles_from) {}

  /// Kinds of planes to seek for a pair: `which`, except that for a pair with an obstacle, `all` replaces `turning`,
  /// because obstacles move fast and turn. If a ball hits a cloth, this takes 12 % fewer iterations than `turning`.
  PlaneKinds kinds_of(const CornerPair& pair, PlaneKinds which) const {
    const bool with_obstacle = pair.a[0] >= obstacles_from_ || pair.b[0] >= obstacles_from_;
    return which == PlaneKinds::turning && with_obstacle ? PlaneKinds::all : which;
  }

  /// Sets the watched pairs, makes x [m] the reference, and seeks a direction that separates each
  /// pair there.
  void watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x);
  /// As above, for the pairs received by swap_pairs().
  void watch(std::span<const Vec3> x);
  /// Swaps the list of watched pairs with `pairs`, so that no list is copied. Call watch(x) afterwards.
  void swap_pairs(PairList& pairs) { std::swap(pairs_, pairs); }

  /// Number of watched pairs.
  std::size_t size() const { return pairs_.size(); }
  /// Sets how far the vertices have `moved` from the reference [m], for append_closer().
  /// find_failing() overwrites these distances.
  void set_moved(std::span<const float> moved);
  /// Appends those of the watched pairs [begin, end) that may be closer than `radius` [m] after the motion of
  /// set_moved(): a gap along any direction is a lower bound of the distance.
  void append_closer(double radius, std::size_t begin, std::size_t end, PairList& out) const;

  /// Appends the pairs without a separating plane on the trajectory from x_t0 to x_t1. `reference`: positions of the
  /// last watch() [m]. `moved`: per vertex, a bound of its distance from the reference at both times [m]. `changed`:
  /// per vertex, whether x_t0 or x_t1 differs from that of the last call. `carried`: start positions of pairs with an
  /// obstacle that turns; these pairs are always tested. `which`: see kinds_of().
  void find_failing(std::span<const Vec3> reference, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                    std::span<const float> moved, std::span<const std::uint8_t> changed,
                    std::vector<CornerPair>& failing, const CarriedStarts* carried = nullptr,
                    PlaneKinds which = PlaneKinds::all);

  /// Saves or restores the planes that differ from those that watch() finds at the `reference`. Before restoring, watch
  /// the same pairs at the same reference.
  template <class Archive>
  void serialize(Archive& archive, std::span<const Vec3> reference);

 private:
  struct Plane {
    std::array<float, 3> n;
    float gap;  // at the reference, minus 1.5 Numerics::Separation::least_gap and rounding [m]; may be < 0
    bool is_known() const { return n[0] != 0 || n[1] != 0 || n[2] != 0; }
    bool operator==(const Plane&) const = default;
  };
  void find_planes_for_eight(std::size_t first, std::size_t count);
  /// Arguments of find_failing().
  struct Trajectory {
    std::span<const Vec3> reference, x_t0, x_t1;
    const CarriedStarts* carried;
    PlaneKinds which;
  };
  void find_failing(std::size_t begin, std::size_t end, const Trajectory& trajectory, std::vector<CornerPair>& failing);

  std::span<const Triangle> triangles_;
  Index obstacles_from_ = 0;
  PairList pairs_;
  std::vector<Plane> planes_;
  std::vector<Lanes4> rounded_;             // positions in float, for the search in watch()
  std::vector<float> moved_;                // per triangle: bound of the distances of its corners from the reference
  std::vector<std::uint8_t> changed_;       // per triangle: x_t0 or x_t1 of a corner differs from that of the last call
  std::vector<std::uint8_t> is_separated_;  // per pair: its last test, from x_t0 (no carried start), found a plane
};

}  // namespace weft::collision
