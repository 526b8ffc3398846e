// Broad phase with reuse: collects candidate pairs of triangles and keeps them while they stay valid.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/variants/coherence.hpp"

namespace weft::collision {

struct SearchParameters {
  bool self = true;        ///< cloth against itself and other cloth
  bool obstacles = true;   ///< cloth or rigid bodies against obstacles or rigid bodies
  bool reuse = true;       ///< keep candidate pairs over several slow steps (see CandidateCache)
  bool coherence = false;  ///< keep closest points instead of candidate pairs (see CoherentDetection)
  BroadPhaseOptions broad_phase = {};
};

/// Collects candidate pairs: pairs of triangles whose bounds overlap on the linear trajectories
/// from x_t0 to x_t1. The bounds are enlarged by a margin at both ends. The margin is half the
/// detection distance. (Features closer than the detection distance are near.) In slow steps,
/// SearchParameters::reuse adds a Verlet margin of 2 · Numerics::Contact::verlet_margin detection
/// distances. A step is slow if every vertex moves by less than the Verlet margin along each axis.
///
/// The pairs are valid for a later step if, in that step, each vertex starts within the Verlet
/// margin of its start at the search and ends inside its bounds. Features that are near at such a
/// start were closer than radius() at the search. Thus cloth at rest is searched only once.
///
/// An obstacle is clear if, along one axis, it is at least two detection distances away from the bounding box of the
/// trajectories of all particles. While the obstacle stays at least that far from this box, its motion neither makes a
/// step fast nor invalidates the pairs.
///
/// Bounds at the start and at the end are compared separately. So triangles that move together with a gap between them
/// are no candidate pair. (The scene sphere_drape with 256² particles has 4 candidate pairs per particle. With one
/// bound for the whole trajectory, it would have 70.)
class CandidateCache {
 public:
  /// `bodies` must outlive it. `x`: all vertices at the start of the run [m]. `detection_distance`: in [m].
  CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x,
                 double detection_distance);

  /// Replaces pairs() by the candidate pairs of the trajectory from x_t0 to x_t1. They include all pairs of triangles
  /// without a common vertex that come closer than the detection distance. Sets the bounds that covers_start(),
  /// covers_end() and lists_near() test. The caller may remove pairs from the list that is returned.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Collects again, after vertices have been pushed apart to x_t1. If a vertex has left the bounds
  /// of its end, these bounds grow to contain its x_t0 and its x_t1, because the vertex may later
  /// be moved back from x_t1 to x_t0. If `all` is true, the bounds of all vertices grow in this
  /// way.
  CandidatePairs& collect_more(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, bool all);

  /// As the first collect(), but each vertex may end anywhere in the box between `low_t1` and `high_t1`.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> low_t1, std::span<const Vec3> high_t1);

  /// The list that collect() fills.
  CandidatePairs& pairs() { return pairs_; }

  /// If covers_start(x) is true, features that are near at x were closer than this when the pairs
  /// were collected [m].
  double radius() const { return 2 * margin_; }
  double detection_distance() const { return detection_distance_; }

  /// Whether each vertex at x is kept clear (is_kept_clear()) or is within the Verlet margin of its
  /// start at the search. If the search had no Verlet margin, the vertex must be exactly at that
  /// start. This function and the next two return false if no pairs are valid.
  bool covers_start(std::span<const Vec3> x) const;
  /// Whether each vertex at x is kept clear or is inside the bounds of its end. If so, and if
  /// covers_start() is true for the start of a trajectory to x, the pairs include all that can meet
  /// on it.
  bool covers_end(std::span<const Vec3> x) const { return are_at_end(x, margin_); }

  /// If this returns true, the pairs include the triangles of all features that are near at x. It may return false
  /// although they do.
  bool lists_near(std::span<const Vec3> x) const { return are_at_end(x, margin_ - 0.5 * detection_distance_); }

  /// Whether the bounds of hierarchies() contain all vertices at x, also those of clear obstacles. It may return false
  /// although they do.
  bool bounds_contain(std::span<const Vec3> x) const;

  /// Whether a vertex at x lies in the half-space that contains its obstacle and no particle; false if no such
  /// half-space is known.
  bool is_kept_clear(std::size_t vertex, const Vec3& x) const;

  /// For callers that collect pairs themselves: declares the pairs valid for ends within `margin` [m] of x_t1, and for
  /// starts within (`margin` − half the detection distance) of x_t0.
  void cover(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    find_clear_bodies(Motion(x_t0, x_t1));
    cover(Motion(x_t0, x_t1), margin);
  }

  /// Whether this body is a clear obstacle: no particle can meet it while covers_start() and covers_end() are true.
  bool is_clear(std::size_t body) const { return clear_[body].sign != 0; }

  /// The pairs of surfaces (a < b, or a = b) to search.
  const std::vector<SurfacePair>& surface_pairs() const { return surface_pairs_; }
  /// The hierarchies. Their bounds contain all vertices, except those of clear obstacles, on every
  /// trajectory for which covers_start() and covers_end() are true.
  BroadPhase& hierarchies() { return broad_phase_; }
  const BroadPhase& hierarchies() const { return broad_phase_; }

  /// Invalidates the pairs: covers_start(), covers_end() and lists_near() return false until pairs
  /// are collected again.
  void invalidate() { margin_ = -1; }

  /// Call between two steps. If separation lists or velocity cones are enabled, drops their state
  /// and invalidates the pairs, so that later results do not depend on earlier steps.
  void forget();

  /// Starts, and boxes of the ends, for which the pairs were collected [m]. Collecting for the same
  /// positions again gives the same pairs.
  std::span<const Vec3> from() const { return from_; }
  std::span<const Vec3> low_end() const { return low_; }
  std::span<const Vec3> high_end() const { return high_.empty() ? low_ : high_; }

 private:
  void cover(const Motion& motion, double margin);
  void refit(const Motion& motion, double margin);
  void find_clear_bodies(const Motion& motion);
  bool is_at_end(std::size_t vertex, const Vec3& x, double margin) const;
  bool are_at_end(std::span<const Vec3> x, double margin) const;

  const Bodies& bodies_;
  SearchParameters parameters_;
  double detection_distance_;
  BroadPhase broad_phase_;
  std::vector<SurfacePair> surface_pairs_;
  CandidatePairs pairs_;
  std::vector<Vec3> from_, low_, high_;  // see from(), low_end(), high_end(); high_ is empty if it equals low_
  double margin_ = -1;                   // of pairs_ [m]; negative: no valid pairs
  /// Half-space without particles: sign · x[axis] >= from. A trajectory with both ends inside stays inside.
  struct HalfSpace {
    int axis = 0;
    double sign = 0;                                        // ±1; 0: no such half-space
    double from = std::numeric_limits<double>::infinity();  // [m]
    bool holds(const Vec3& x) const { return sign * x[axis] >= from; }
  };
  std::vector<HalfSpace> clear_;  // per body: if it is a clear obstacle, a half-space that contains it
};

}  // namespace weft::collision
