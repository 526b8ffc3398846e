// Separating planes of triangle pairs, kept from step to step.
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
#include "physics/collision/response/certificate.hpp"

namespace weft::collision {

/// Stores for each watched pair of triangles a direction, and the gap along it at the reference (the positions at
/// watch()). The gap shrinks by at most the sum of the motions of both triangles since then. While that sum is less
/// than the gap, the pair is separated without a test, so cloth resting on cloth costs one comparison per pair and
/// step. If no corner of a pair has moved since its last successful test, the pair is not tested again either (pushing
/// apart moves few vertices, then tests all pairs).
class Planes {
 public:
  Planes() = default;
  /// Vertices from `obstacles_from` on belong to obstacles.
  explicit Planes(std::span<const Triangle> triangles, Index obstacles_from = 0)
      : triangles_(triangles), obstacles_from_(obstacles_from) {}

  /// Which planes are sought for a pair: `which`, but for pairs with an obstacle `all` instead of `turning`. Obstacles
  /// move fast and turn (measured without this rule: a ball that hits a cloth takes 1.13 times the iterations).
  PlaneKinds kinds_of(const CornerPair& pair, PlaneKinds which) const {
    const bool with_obstacle = pair.a[0] >= obstacles_from_ || pair.b[0] >= obstacles_from_;
    return which == PlaneKinds::turning && with_obstacle ? PlaneKinds::all : which;
  }

  /// Watches these pairs, and finds directions at x [m].
  void watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x);
  /// Watches the pairs received by exchange().
  void watch(std::span<const Vec3> x);
  /// Swaps the list of watched pairs for another, so that only one copy exists; watch() must follow.
  void exchange(PairList& pairs) { std::swap(pairs_, pairs); }

  /// Number of watched pairs.
  std::size_t size() const { return pairs_.size(); }
  /// Sets how far vertices have `moved` from the reference [m], for append_closer(), until find_failing() is called.
  void set_moved(std::span<const float> moved);
  /// Appends those of the watched pairs [begin, end) that may be closer than `radius` [m]. The gap along any direction
  /// is a lower bound of the distance.
  void append_closer(double radius, std::size_t begin, std::size_t end, PairList& out) const;

  /// Appends the pairs without a separating plane on the trajectory from x_t0 to x_t1. `reference`: positions at
  /// watch() [m]. `moved`: per vertex, a bound of its distance from the reference at both times [m]. `changed`: per
  /// vertex, whether x_t0 or x_t1 differs from the last call. `carried`: start positions of pairs with obstacles that
  /// turn; these pairs are always tested.
  void find_failing(std::span<const Vec3> reference, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                    std::span<const float> moved, std::span<const std::uint8_t> changed,
                    std::vector<CornerPair>& failing, const CarriedStarts* carried = nullptr,
                    PlaneKinds which = PlaneKinds::all);

  /// Saves the planes that differ from those that watch() finds for these pairs at the reference. A new object that
  /// watches the same pairs needs nothing else.
  template <class Archive>
  void serialize(Archive& archive, std::span<const Vec3> reference);

 private:
  struct Plane {
    std::array<float, 3> n;
    float gap;  // at the reference, less 1.5 times Numerics::Separation::least_gap and rounding [m]; may be negative
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
  std::vector<std::uint8_t> changed_;       // per triangle
  std::vector<std::uint8_t> is_separated_;  // per pair: separated at the last test from x_t0
};

}  // namespace weft::collision
