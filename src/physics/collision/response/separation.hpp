// Guarantees that no two triangles meet (touch or cross) during a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/response/carried_starts.hpp"
#include "physics/collision/response/pinch.hpp"
#include "physics/collision/response/planes.hpp"
#include "physics/collision/response/separating_plane.hpp"
#include "physics/collision/response/vertex_stars.hpp"

namespace weft::collision {

/// Mobility of a vertex. Fixed: vertices of obstacles, and of rigid bodies that forces do not move yet. Pinned: pinned
/// particles, which move only if there is no other way. Free: all other particles.
enum Movable : std::uint8_t { kFixed = 0, kFree = 1, kPinned = 2 };

/// A pinned particle that had to move because it obstructed a pair, and that pair.
struct ObstructedPin {
  Index particle;
  CornerPair pair;
};

struct SeparationReport {
  bool separated = false;                      ///< each pair has a separating plane, is exempt, or is fully backtracked
  std::vector<ObstructedPin> obstructed_pins;  ///< pinned particles that had to move
  CornerPair unseparated_pair{};               ///< if not `separated`: a pair that is not separated
};

/// Vertices that move only together: the surface vertices of a rigid body, and its frame particles (mesh::RigidFrame).
struct RigidGroup {
  Index first, count;  ///< surface vertices: the first one, and their number
  Index frame;         ///< first of the frame particles
  double mass;         ///< [kg]
};

/// Keeps triangles apart on the linear motion from x_t0 to x_t1, by separating planes (separating_plane.hpp). Pairs
/// without a common vertex are tested one by one. Pairs of triangles of one surface with one common vertex are tested
/// by vertex stars (VertexStars). Triangles with a common edge are not tested: they meet only if they are folded
/// exactly onto each other.
///
/// If a pair has no separating plane, enforce() corrects the ends x_t1 of its vertices:
///   1. It pushes the two triangles apart along a direction n, so that a gap remains. n is the
///      direction between the closest points at the start. If the push along the normal of a face
///      that does not move is shorter, n is this normal. It then tests again and pushes the pairs
///      that fail, in up to Numerics::Separation::max_rounds rounds. It never pushes fixed vertices,
///      and pinned ones only if there is no other way.
///   2. It backtracks the particles of pairs that still fail: moves them back towards their start,
///      finally all the way. If the pair has an obstacle that moves rigidly, the particles go to
///      their carried start instead (CarriedStarts). No pair meets at the start. So two triangles
///      do not meet if all their vertices end at their start, or if one obstacle carries all of
///      them. The set of backtracked particles grows until no pair fails.
///   3. If a pair still fails, fixed vertices that move differently force it together. Cloth can then be exempted from
///      the obstacle.
///
/// A rigid body pushes cloth as an obstacle does: the push does not move the body. Pushes translate rigid bodies away
/// from obstacles and from each other, the lighter body farther.
class Separation {
 public:
  /// `triangles`: of all surfaces, by global number. `deformable`: surfaces that can collide with themselves. `masses`:
  /// of the particles [kg]; if empty, all are equal. `triangles` and `masses` must outlive it.
  Separation(std::span<const Triangle> triangles, std::span<const Surface> deformable,
             std::span<const double> masses = {});

  /// Sets the rigid groups. `vertices`: number of all vertices. Call before the first watch().
  void set_rigid(std::vector<RigidGroup> groups, Index vertices);

  /// Sets the pairs to watch, that is, to test for a separating plane; they have no common vertex. x [m] becomes the
  /// reference from which motion is measured, also for the vertex stars. The pairs must include all that can meet. If a
  /// vertex moves out of the bounds for which the pairs were collected, collect the pairs and call watch() again.
  void watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x);
  /// As above, for the pairs received by swap_pairs().
  void watch(std::span<const Vec3> x);
  /// As Planes::swap_pairs().
  void swap_pairs(PairList& pairs) { planes_.swap_pairs(pairs); }

  /// Number of watched pairs.
  std::size_t pair_count() const { return planes_.size(); }
  /// Measures how far the vertices at x [m] are from the reference, for append_closer().
  /// find_failing() and enforce() overwrite the result.
  void measure_motion(std::span<const Vec3> x);
  /// Appends those of the watched pairs [begin, end) that may be closer than `radius` [m] at the x of measure_motion().
  void append_closer(double radius, std::size_t begin, std::size_t end, PairList& out) const {
    planes_.append_closer(radius, begin, end, out);
  }

  /// Flags clear triangles by 1: a triangle is clear if, at x [m], its features are farther than `distance` [m] from
  /// those of all triangles that share a vertex with it. Pairs of features with a common vertex do not count. May miss
  /// clear triangles.
  std::vector<std::uint8_t> find_clear_triangles(double distance, std::span<const Vec3> x) const;

  /// Returns the pairs without a separating plane on the trajectory from x_t0 to x_t1. Changes no
  /// positions. x_t0 must be free of intersections, except of pairs that `pinched` exempts; these
  /// are skipped. A pair with an obstacle that turns is tested in the frame of that obstacle
  /// (`carried`). `which`: kinds of planes that are sought. If the last call found a pair
  /// separated, and its vertices still have the same x_t0 and x_t1, the pair is not tested again,
  /// whatever `which` was then.
  std::span<const CornerPair> find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                           const PinchedPairs* pinched = nullptr,
                                           const CarriedStarts* carried = nullptr, PlaneKinds which = PlaneKinds::all);
  /// Makes the next find_failing() test all pairs, as watch() does.
  void forget_tests() { tested_t0_.clear(); }

  /// Changes x_t1 of movable vertices until each pair is separated (see
  /// SeparationReport::separated). Pairs of cloth and obstacle for which this is impossible are
  /// added to `pinched`, if given. `is_continued`: true if only the watched pairs have changed
  /// since the last call; each vertex is then backtracked to the same start or carried start as in
  /// that call.
  SeparationReport enforce(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                           PinchedPairs* pinched = nullptr, const CarriedStarts* carried = nullptr,
                           bool is_continued = false, PlaneKinds which = PlaneKinds::all);

  /// Saves or restores the planes found since watch(). Before restoring, watch the same pairs at the same positions.
  template <class Archive>
  void serialize(Archive& archive) {
    planes_.serialize(archive, reference_);
  }

 private:
  /// Arguments and state of enforce().
  struct Step {
    std::span<const Vec3> x_t0;
    std::span<Vec3> x_t1;
    std::vector<std::uint8_t> movable;
    PinchedPairs* pinched;
    const CarriedStarts* carried;
    PlaneKinds which;
    SeparationReport report = {};
    std::span<const Vec3> start_of(const CornerPair& pair) const { return carried ? carried->of(pair, x_t0) : x_t0; }
  };
  void set_reference(std::span<const Vec3> x);
  double balanced_plane(const CornerPair& pair, const Vec3& n, double target, const Step& step) const;
  Vec3 push_direction(const CornerPair& pair, const Vec3& closest, const Step& step) const;
  bool push_apart(const CornerPair& pair, Step& step) const;
  bool translate_groups(const CornerPair& pair, const Vec3& n, double target, Step& step) const;
  const RigidGroup* group_of(Index v) const {
    return group_of_.empty() || group_of_[v] < 0 ? nullptr : &groups_[group_of_[v]];
  }
  /// Whether push_apart() leaves a vertex in place, or moves it only with its rigid body.
  bool is_fixed(Index v, const Step& step) const { return step.movable[v] != kFree || group_of(v) != nullptr; }
  template <class Visit>
  static void for_each_member(const RigidGroup& group, const Visit& visit);
  bool release_pins(const CornerPair& pair, Step& step);
  bool choose_backtrack_targets(const CornerPair& pair, const Step& step);
  const Vec3& backtrack_target(Index v, const Step& step) const;
  bool has_carried_vertex(const CornerPair& pair) const;
  bool backtrack(const CornerPair& pair, bool all_the_way, Step& step);
  bool backtrack_all(Step& step) const;
  bool is_backtracked(const CornerPair& pair, const Step& step) const;
  void test_again(const Step& step);

  std::span<const Triangle> triangles_;
  std::span<const double> masses_;  // of the particles
  std::vector<Vec3> reference_;
  Planes planes_;
  VertexStars stars_;
  std::vector<float> moved_;                 // per vertex: bound of its distance from the reference at both ends [m]
  std::vector<Vec3> tested_t0_, tested_t1_;  // per vertex: position at the last test [m]
  std::vector<std::uint8_t> changed_;        // per vertex: x_t0 or x_t1 differs from that of the last test
  std::vector<int> backtracked_in_;          // per vertex: round in which it was last backtracked; 0: never
  std::vector<RigidGroup> groups_;
  std::vector<int> group_of_;  // per vertex: index in groups_, −1: none; empty if there are no groups
  std::vector<int> carriers_;  // per vertex: obstacle whose carried start is its backtrack target, or a constant below
  // With these constants, the target is x_t0. kAlwaysAtStart stays until carriers_ is reset.
  static constexpr int kAtStart = -1, kAlwaysAtStart = -2;
  int round_ = 0;
  std::vector<CornerPair> failing_;
};

}  // namespace weft::collision
